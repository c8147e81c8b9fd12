// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/parameters/population_prior.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::calibrate {

namespace {

/// The free joint parameters: their indices, nominal values and tolerances.
struct JointParameters {
  std::vector<Eigen::Index> index;
  std::vector<ParameterAddress> address;
  VectorXd mean, tolerance;
};

JointParameters joint_parameters(const ParameterSet& set) {
  JointParameters numbers;
  std::vector<double> mean, tolerance;
  const auto free = set.free();
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (!is_joint_parameter(free[k]->at) || !std::isfinite(free[k]->prior_sd)) continue;
    numbers.index.push_back(static_cast<Eigen::Index>(k));
    numbers.address.push_back(free[k]->at);
    mean.push_back(free[k]->nominal), tolerance.push_back(free[k]->prior_sd);
  }
  numbers.mean = Eigen::Map<const VectorXd>(mean.data(), static_cast<Eigen::Index>(mean.size()));
  numbers.tolerance = Eigen::Map<const VectorXd>(tolerance.data(), static_cast<Eigen::Index>(tolerance.size()));
  return numbers;
}

/// Square root R of the information matrix, RᵀR = covariance⁻¹: the transposed Cholesky factor of the inverse.
MatrixXd information_root(const MatrixXd& covariance) {
  return cholesky_but_for_rounding(invert_but_for_rounding(covariance)).transpose();
}

/// Parameters k of `index` get mean `shift` and this covariance, both in tolerances from nominal.
ParameterSet with_joint_prior(ParameterSet set, const JointParameters& numbers, const VectorXd& shift,
                              const MatrixXd& covariance) {
  const Eigen::Index n = numbers.mean.size();
  const MatrixXd root = information_root(covariance) * numbers.tolerance.cwiseInverse().asDiagonal();
  set.prior_sqrt_information = prior_sqrt_information_of(set);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) set.prior_sqrt_information(numbers.index[i], numbers.index[j]) = root(i, j);
  Eigen::Index i = 0;
  for (Parameter& parameter : set.parameters) {
    if (i == n || !parameter.free || !(parameter.at == numbers.address[i])) continue;
    parameter.nominal += shift[i] * numbers.tolerance[i];
    parameter.prior_sd = std::sqrt(covariance(i, i)) * numbers.tolerance[i];
    ++i;
  }
  return set;
}

}  // namespace

ParameterSet with_population_prior(ParameterSet set, std::span<const Chain> robot_population) {
  if (robot_population.empty()) return set;
  const JointParameters numbers = joint_parameters(set);
  const Eigen::Index n = numbers.mean.size();
  const double count = 1.0 + static_cast<double>(robot_population.size());
  MatrixXd deviation(n, static_cast<Eigen::Index>(robot_population.size()));  // in tolerances
  for (std::size_t robot = 0; robot < robot_population.size(); ++robot)
    for (Eigen::Index i = 0; i < n; ++i)
      deviation(i, static_cast<Eigen::Index>(robot)) =
          (value_at(robot_population[robot], numbers.address[i]) - numbers.mean[i]) / numbers.tolerance[i];
  const VectorXd shift = deviation.rowwise().sum() / count;
  deviation.colwise() -= shift;
  const MatrixXd covariance = (MatrixXd::Identity(n, n) + times_transposed(deviation, deviation)) / count;
  return with_joint_prior(std::move(set), numbers, shift, covariance);
}

ParameterSet with_population_prior(ParameterSet set, const PopulationPrior& population) {
  const JointParameters all = joint_parameters(set);
  const auto free = set.free();
  JointParameters numbers;
  std::vector<Eigen::Index> own;  // index in `all`
  std::vector<Eigen::Index> of;   // index in the population
  for (std::size_t i = 0; i < all.index.size(); ++i) {
    const auto at = std::ranges::find(population.names, free[static_cast<std::size_t>(all.index[i])]->name);
    if (at == population.names.end()) continue;
    numbers.index.push_back(all.index[i]), numbers.address.push_back(all.address[i]);
    own.push_back(static_cast<Eigen::Index>(i)), of.push_back(at - population.names.begin());
  }
  if (own.empty()) return set;
  numbers.mean = all.mean(own), numbers.tolerance = all.tolerance(own);
  const VectorXd per_tolerance = numbers.tolerance.cwiseInverse();
  const VectorXd shift = (VectorXd(population.mean(of)) - numbers.mean).cwiseProduct(per_tolerance);
  const MatrixXd block = population.covariance(of, of);
  return with_joint_prior(std::move(set), numbers, shift,
                          per_tolerance.asDiagonal() * block * per_tolerance.asDiagonal());
}

Chain with_joint_parameters_of(const Chain& chain, const Chain& earlier, const ParameterSet& set) {
  Chain result = chain;
  for (const Parameter& parameter : set.parameters)
    if (is_joint_parameter(parameter.at)) set_value_at(result, parameter.at, value_at(earlier, parameter.at));
  return result;
}

}  // namespace kinfer::calibrate
