// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/functions/field_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "kinfer/calibrate/functions/thresholds.hpp"
#include "kinfer/estimate/poses/pose_normal_equations.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

/// Indices of the bases that rows can have: −1 is the chain's own.
std::vector<int> bases_of(const Chain& chain) {
  std::vector<int> bases{-1};
  for (std::size_t m = 0; m < chain.mountings.size(); ++m)
    if (chain.mountings[m].base) bases.push_back(static_cast<int>(m));
  return bases;
}

/// The free parameters of `set`, then those coordinates of bases and anchors that are not among them; and the indices
/// of the coordinates of each.
struct WithTranslations {
  ParameterSet set;
  std::vector<std::array<Index, 3>> bases{}, anchors{};
};

WithTranslations with_translations(const Chain& chain, const ParameterSet& set, const PoseSet& rows) {
  WithTranslations all{{set.parameters, {}}};
  std::vector<ParameterAddress> addresses;
  for (const Parameter* parameter : set.free()) addresses.push_back(parameter->at);
  const auto indices_of = [&](auto address_of) {
    std::array<Index, 3> indices{};
    for (const Field field : {Field::x, Field::y, Field::z}) {
      const ParameterAddress at = address_of(field);
      const auto found = std::ranges::find(addresses, at);
      indices[static_cast<std::size_t>(field)] = found - addresses.begin();
      if (found != addresses.end()) continue;
      all.set.parameters.push_back(parameter_at(chain, at, 1.0));
      addresses.push_back(at);
    }
    return indices;
  };
  for (const int mounting : bases_of(chain))
    all.bases.push_back(indices_of([&](Field field) { return FrameNumber{SetupFrame::base, field, mounting}; }));
  const int anchors = rows.distances.empty() ? 0 : static_cast<int>(chain.fixtures.anchors.size());
  for (int i = 0; i < anchors; ++i)
    all.anchors.push_back(indices_of([&](Field field) { return FixtureNumber{fixture_kind("anchor"), i, field}; }));
  return all;
}

Chain without_field(Chain chain) {
  chain.field = {};
  return chain;
}

double log_half_cauchy(double ratio) {  // density of the logarithm
  return std::log(2.0 / std::numbers::pi * ratio / (1.0 + ratio * ratio));
}

/// `count` numbers from `first` to `last`, each the same multiple of the one before.
std::vector<double> geometric_sequence(double first, double last, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(first * std::pow(last / first, k / (count - 1.0)));
  return values;
}

}  // namespace

FieldProblem::FieldProblem(const Chain& chain, const ParameterSet& set, const WeightedRows& data)
    : chain_(chain), set_(set), roots_(roots_of(chain.field)) {
  linearise(data);
  eliminate_parameters();
}

void FieldProblem::linearise(const WeightedRows& data) {
  const Chain plain = without_field(chain_);
  const auto [all, base_indices, anchor_indices] = with_translations(plain, set_, data.rows);
  VectorXd r;
  MatrixXd jacobian;
  pose_residuals(plain, all, data.rows, data.weights, data.threads).evaluate(pack(all, plain), r, &jacobian);
  const Index parameters = set_.free_count(), count = r.size() - all.free_count();
  residuals_ = r.head(count), by_parameter_ = jacobian.topLeftCorner(count, parameters);
  // Each row has one base: its derivatives by the translations of all others are zero.
  const std::vector<int> bases = bases_of(chain_);
  MatrixXd slopes = MatrixXd::Zero(count, 3);
  for (std::size_t b = 0; b < bases.size(); ++b)
    slopes +=
        jacobian.topRows(count)(Eigen::all, base_indices[b]) * with_mounting(chain_, bases[b]).base.pose().rotation;
  // Anchors move with the base, so that its translation changes no wire: a displaced tool is as anchors displaced back.
  for (const std::array<Index, 3>& indices : anchor_indices) slopes -= jacobian.topRows(count)(Eigen::all, indices);

  const Index values = roots_.inverse_root.cols();
  MatrixXd features(data.rows.rows(), values);
  for (Index row = 0; row < features.rows(); ++row)
    features.row(row) = kernel_at(chain_.field, data.rows.joints.col(row)).transpose() * roots_.inverse_root;
  by_value_ = MatrixXd::Zero(count, 3 * values);
  Index i = 0;  // behind the blocks follow socket distances, on which no displacement acts
  for (const Block& block : blocks_of(data.rows))
    for (int k = 0; k < block.size; ++k, ++i)
      for (int c = 0; c < 3; ++c) by_value_.row(i).segment(c * values, values) = slopes(i, c) * features.row(block.row);
}

void FieldProblem::eliminate_parameters() {
  const MatrixXd prior = prior_information(set_), measured = gram(by_parameter_);
  const VectorXd offset = pack(set_, chain_) - nominal_of(set_), pull = prior * offset;
  inverse_ = invert_but_for_rounding(measured + prior);
  gradient_ = by_parameter_.transpose() * residuals_ + pull;
  const MatrixXd across = transposed_times(by_parameter_, by_value_);
  explained_ = product(inverse_, across);
  information_ = gram(by_value_) - transposed_times(across, explained_);
  image_ = explained_.transpose() * gradient_ - by_value_.transpose() * residuals_;
  squares_ = residuals_.squaredNorm() + offset.dot(pull) - gradient_.dot(inverse_ * gradient_);
  redundancy_ = std::max(1.0, static_cast<double>(residuals_.size()) - inverse_.cwiseProduct(measured).sum());
}

FieldProblem::Spectrum FieldProblem::spectrum() const {
  const SymmetricEigen eigen = symmetric_eigen(information_);
  return {eigen.values.cwiseMax(0.0), (eigen.vectors.transpose() * image_).cwiseAbs2()};
}

double FieldProblem::log_evidence(const Spectrum& of, double size, double noise) const {
  const double factor = size * size / noise;
  const Eigen::ArrayXd gain = 1.0 + factor * of.information.array();
  const double explained = factor / noise * (of.squared_image.array() / gain).sum();
  return -0.5 * (redundancy_ * std::log(noise) + squares_ / noise - explained + gain.log().sum());
}

FieldProblem::Evidence FieldProblem::evidence(double scale) const {
  const Spectrum of = spectrum();
  const std::vector<double> noises =
      geometric_sequence(thresholds::least_field_noise, thresholds::largest_field_noise, thresholds::field_noises);
  const std::vector<double> sizes = geometric_sequence(thresholds::least_field_size * scale,
                                                       thresholds::largest_field_size * scale, thresholds::field_sizes);
  // The noise level is the best one in each case, that without a field being known in closed form.
  const double without = log_evidence(of, 0.0, squares_ / redundancy_), spacing = std::log(sizes[1] / sizes[0]);
  Evidence best;
  std::vector<double> parts;
  for (const double size : sizes) {
    double most = -std::numeric_limits<double>::infinity(), noise = 1.0;
    for (const double v : noises)
      if (const double log = log_evidence(of, size, v); log > most) most = log, noise = v;
    const double part = most - without + log_half_cauchy(size / scale) + std::log(spacing);
    if (parts.empty() || part > *std::ranges::max_element(parts)) best.size = size, best.noise = noise;
    parts.push_back(part);
  }
  best.log_bayes_factor = log_sum(parts);
  return best;
}

FieldProblem::Solution FieldProblem::solve(double size, double noise) const {
  MatrixXd matrix = information_ / noise;
  // Beside rounding, which is relative to the largest.
  matrix.diagonal().array() += 1.0 / (size * size) + thresholds::field_rounding * matrix.diagonal().maxCoeff();
  const MatrixXd covariance = invert_but_for_rounding(matrix);
  Solution found{{}, covariance * image_ / noise, size, {}, {}, 0.0};
  found.step = -(inverse_ * gradient_ + explained_ * found.values);
  found.covariance = inverse_;
  found.marginal_variances =
      inverse_.diagonal() + product(explained_, covariance).cwiseProduct(explained_).rowwise().sum();
  found.effective_number = static_cast<double>(matrix.cols()) - covariance.trace() / (size * size);
  return found;
}

Chain FieldProblem::moved_by(const Solution& solution) const {
  Chain moved = unpack(set_, chain_, pack(set_, chain_) + solution.step);
  moved.field.size = solution.size;
  moved.field.coefficients =
      (roots_.inverse_root * solution.values.reshaped(roots_.inverse_root.cols(), 3)).transpose();
  return moved;
}

double FieldProblem::relative_gain(const Solution& solution) const {
  const double before = residuals_after(VectorXd::Zero(set_.free_count()), present_values()).norm();
  return before > 0.0 ? 1.0 - residuals_after(solution.step, solution.values).norm() / before : 0.0;
}

VectorXd FieldProblem::residuals_after(const VectorXd& step, const VectorXd& values) const {
  return residuals_ + by_parameter_ * step + by_value_ * values;
}

VectorXd FieldProblem::present_values() const {
  const MatrixXd values = roots_.root.transpose() * chain_.field.coefficients.transpose();
  return values.reshaped();
}

}  // namespace kinfer::calibrate
