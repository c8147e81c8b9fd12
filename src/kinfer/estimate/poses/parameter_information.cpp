// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/parameter_information.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

/// The free parameters of the joints that a data sheet states, in the order of `estimate.values`.
struct JointParameterList {
  std::vector<Eigen::Index> index;
  std::vector<double> nominal, tolerance;
};

JointParameterList listed_joint_parameters(const Estimate& estimate, const NominalModel& model) {
  const ParameterSet sheet = all_parameters(model.chain, model.tolerances);
  const auto free = estimate.parameters.free();
  JointParameterList list;
  for (std::size_t k = 0; k < free.size() && model.chain.joints.size() == estimate.chain.joints.size(); ++k) {
    const auto stated = std::ranges::find(sheet.parameters, free[k]->at, &Parameter::at);
    if (!is_joint_parameter(free[k]->at) || stated == sheet.parameters.end() || !std::isfinite(stated->prior_sd))
      continue;
    list.index.push_back(static_cast<Eigen::Index>(k));
    list.nominal.push_back(stated->nominal), list.tolerance.push_back(stated->prior_sd);
  }
  return list;
}

MatrixXd joint_block(const MatrixXd& matrix, const std::vector<Eigen::Index>& index) {
  const auto n = static_cast<Eigen::Index>(index.size());
  MatrixXd block(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      block(i, j) = matrix(index[static_cast<std::size_t>(i)], index[static_cast<std::size_t>(j)]);
  return block;
}

}  // namespace

std::optional<ParameterInformation> information_of(const Estimate& estimate, const NominalModel& model) {
  const JointParameterList list = listed_joint_parameters(estimate, model);
  const auto n = static_cast<Eigen::Index>(list.index.size());
  if (n == 0) return std::nullopt;
  ParameterInformation result;
  result.nominal = Eigen::Map<const VectorXd>(list.nominal.data(), n);
  result.tolerance = Eigen::Map<const VectorXd>(list.tolerance.data(), n);
  VectorXd found(n), centre(n);  // in tolerances from nominal
  const VectorXd prior_mean = nominal_of(estimate.parameters);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index k = list.index[static_cast<std::size_t>(i)];
    const ParameterEstimate& value = estimate.values[static_cast<std::size_t>(k)];
    result.names.push_back(value.name);
    found[i] = (value.value - result.nominal[i]) / result.tolerance[i];
    centre[i] = (prior_mean[k] - result.nominal[i]) / result.tolerance[i];
  }
  const VectorXd per_tolerance = result.tolerance.cwiseInverse();
  const MatrixXd covariance =
      per_tolerance.asDiagonal() * joint_block(estimate.covariance, list.index) * per_tolerance.asDiagonal();
  const auto posterior = invert_spd(covariance);
  if (!posterior) return std::nullopt;
  // Joints and all else are independent a priori, so the joints' prior is this block.
  const MatrixXd prior = result.tolerance.asDiagonal() *
                         joint_block(gram(prior_sqrt_information_of(estimate.parameters)), list.index) *
                         result.tolerance.asDiagonal();
  const MatrixXd information = *posterior - prior;
  result.information = 0.5 * (information + information.transpose());
  result.vector = *posterior * found - prior * centre;
  return without_weak_directions(std::move(result));
}

ParameterInformation without_weak_directions(ParameterInformation data) {
  constexpr double ten_tolerances = 0.01;  // information, [1 / tolerance²]
  constexpr double numeric = 1e-9;         // of the largest; files have ten digits
  SymmetricEigen eigen = symmetric_eigen(data.information);
  const double least = std::max(ten_tolerances, numeric * eigen.values.cwiseAbs().maxCoeff());
  const VectorXd kept = (eigen.values.array() > least).cast<double>();
  const MatrixXd vectors = eigen.vectors * kept.asDiagonal();
  data.information = times_transposed(vectors * eigen.values.asDiagonal(), vectors);
  data.vector = vectors * (vectors.transpose() * data.vector);
  return data;
}

std::optional<double> log_marginal_likelihood(const ParameterInformation& data, ConstVectorRef mean,
                                              ConstMatrixRef covariance) {
  const auto inverse = invert_spd(covariance);
  const auto prior_root = cholesky(covariance);
  if (!inverse || !prior_root) return std::nullopt;
  const auto root = cholesky(data.information + *inverse);
  const VectorXd gradient = data.vector - data.information * mean;
  const auto step = solve_spd(data.information + *inverse, gradient);
  if (!root || !step) return std::nullopt;
  const double log_volume = (root->diagonal().array() * prior_root->diagonal().array()).log().sum();
  return 0.5 * gradient.dot(*step) + data.vector.dot(mean) - 0.5 * mean.dot(data.information * mean) - log_volume;
}

}  // namespace kinfer
