// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/functions/series_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "kinfer/calibrate/functions/thresholds.hpp"
#include "kinfer/estimate/poses/pose_normal_equations.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

constexpr double first_variance = thresholds::first_series_size * thresholds::first_series_size,
                 largest_variance = thresholds::largest_series_size * thresholds::largest_series_size;

}  // namespace

SeriesProblem::SeriesProblem(const DetachedSeries& apart, const WeightedRows& data)
    : apart_(apart),
      system_(make_system(apart, data)),
      parameters_(apart.set.free_count()),
      prior_(MatrixXd::Zero(system_.gradient.size(), system_.gradient.size())),
      pull_(VectorXd::Zero(system_.gradient.size())),
      offset_(VectorXd::Zero(system_.gradient.size())) {
  const MatrixXd of_parameters = prior_information(apart.set);
  prior_.topLeftCorner(parameters_, parameters_) = of_parameters;
  offset_.head(parameters_) = pack(apart.set, apart.plain) - nominal_of(apart.set);
  pull_.head(parameters_) = of_parameters * offset_.head(parameters_);
  set_variances(present_variances());
}

SeriesProblem::Solution SeriesProblem::solve(double noise) const {
  const MatrixXd covariance = invert_but_for_rounding(system_.matrix / noise + prior_);
  return {-(covariance * (system_.gradient / noise + pull_)), covariance, noise};
}

SeriesProblem::Solution SeriesProblem::maximise(int rounds) {
  Solution s = solve(1.0);
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> variance = variance_;
    for (std::size_t k = 0; k < variance.size(); ++k) {
      const double squares = coefficients(s, k).squaredNorm();
      variance[k] =
          std::clamp(squares / std::max(effective_number(s, k), 1e-3), 1e-8 * largest_variance, largest_variance);
    }
    const double redundancy = static_cast<double>(system_.residuals) - effective_number(s);
    // Of exact residuals what is left is rounding, of either sign.
    const double noise = std::max(thresholds::least_series_noise, residual_squares(s.step) / std::max(1.0, redundancy));
    set_variances(std::move(variance));
    s = solve(noise);
  }
  return s;
}

double SeriesProblem::log_evidence(const Solution& s) const {
  const auto root = cholesky(s.covariance);
  if (!root) return -std::numeric_limits<double>::infinity();  // beside measurements without noise
  const VectorXd at = offset_ + s.step;
  double sum = residual_squares(s.step) / s.noise + at.dot(prior_ * at) +
               static_cast<double>(system_.residuals) * std::log(s.noise) - 2.0 * root->diagonal().array().log().sum();
  for (std::size_t k = 0; k < variance_.size(); ++k)
    sum += static_cast<double>(system_.blocks[k].count) * std::log(variance_[k]);
  for (Index k = 0; k < parameters_; ++k)
    if (prior_(k, k) > 0.0) sum -= std::log(prior_(k, k));
  return -0.5 * sum;
}

double SeriesProblem::log_bayes_factor(const Solution& s, std::size_t series) const {
  const SeriesBlock& block = system_.blocks[series];
  const MatrixXd own = s.covariance.block(block.begin, block.begin, block.count, block.count);
  const VectorXd mean = coefficients(s, series);
  const auto root = cholesky(own);
  const auto weighted = solve_spd(own, mean);
  if (!root || !weighted) return 0.0;
  const double size = std::sqrt(variance_[series]) / thresholds::typical_series_size;
  const double prior = std::log(2.0 / std::numbers::pi * size / (1.0 + size * size)),
               width = 0.5 * std::log(std::numbers::pi / std::max(effective_number(s, series), 0.5));
  return 0.5 * mean.dot(*weighted) + root->diagonal().array().log().sum() -
         0.5 * static_cast<double>(block.count) * std::log(variance_[series]) + prior + width;
}

DetachedSeries SeriesProblem::moved_by(const VectorXd& step) const {
  DetachedSeries moved = apart_;
  moved.plain = unpack(apart_.set, apart_.plain, pack(apart_.set, apart_.plain) + step.head(parameters_));
  for (std::size_t k = 0; k < system_.blocks.size(); ++k) {
    const SeriesBlock& block = system_.blocks[k];
    for (int knot = 0; knot < block.knots; ++knot) {
      const Index unknown = block.unknown[static_cast<std::size_t>(knot)];
      moved.series[k].coefficients[knot] = unknown >= 0 ? step[unknown] : 0.0;
    }
  }
  return moved;
}

SeriesProblem::Step SeriesProblem::step() const {
  const Index p = parameters_, n = prior_.cols() - p;
  const MatrixXd matrix = system_.matrix + prior_;
  const VectorXd gradient = system_.gradient + pull_;
  const MatrixXd root = cholesky_but_for_rounding(matrix.bottomRightCorner(n, n));
  const auto lower = root.triangularView<Eigen::Lower>();
  const MatrixXd across = lower.solve(matrix.bottomLeftCorner(n, p));
  const VectorXd own = lower.solve(gradient.tail(n));
  Step found{VectorXd(p + n),
             invert_but_for_rounding(matrix.topLeftCorner(p, p) - across.transpose() * across),
             invert_but_for_rounding(matrix.topLeftCorner(p, p)),
             {}};
  found.step.head(p) = -(found.covariance * (gradient.head(p) - across.transpose() * own));
  found.step.tail(n) = -lower.transpose().solve(own + across * found.step.head(p));
  found.response = of_all_knots(-lower.transpose().solve(across));
  return found;
}

MatrixXd SeriesProblem::of_all_knots(const MatrixXd& of_unknowns) const {
  Index knots = 0;
  for (const SeriesBlock& block : system_.blocks) knots += block.knots;
  MatrixXd all = MatrixXd::Zero(knots, of_unknowns.cols());
  Index row = 0;
  for (const SeriesBlock& block : system_.blocks)
    for (const Index unknown : block.unknown) {
      if (unknown >= 0) all.row(row) = of_unknowns.row(unknown - parameters_);
      ++row;
    }
  return all;
}

double SeriesProblem::relative_gain(const VectorXd& step) const {
  const double before = residual_squares(present()), after = residual_squares(step);
  return before > 0.0 ? 1.0 - std::sqrt(after / before) : 0.0;
}

void SeriesProblem::set_variances(std::vector<double> variance) {
  variance_ = std::move(variance);
  for (std::size_t s = 0; s < variance_.size(); ++s)
    prior_.diagonal().segment(system_.blocks[s].begin, system_.blocks[s].count).setConstant(1.0 / variance_[s]);
}

std::vector<double> SeriesProblem::present_variances() const {
  std::vector<double> variance;
  for (std::size_t k = 0; k < system_.blocks.size(); ++k) {
    const double squares = apart_.series[k].coefficients.squaredNorm();
    const double mean = squares / static_cast<double>(std::max<Index>(1, system_.blocks[k].count));
    variance.push_back(squares == 0.0 ? first_variance : std::clamp(mean, 1e-8 * largest_variance, largest_variance));
  }
  return variance;
}

VectorXd SeriesProblem::coefficients(const Solution& s, std::size_t series) const {
  return s.step.segment(system_.blocks[series].begin, system_.blocks[series].count);
}

VectorXd SeriesProblem::present() const {
  VectorXd step = VectorXd::Zero(prior_.cols());
  for (std::size_t k = 0; k < system_.blocks.size(); ++k) {
    const SeriesBlock& block = system_.blocks[k];
    for (int knot = 0; knot < block.knots; ++knot)
      if (const Index unknown = block.unknown[static_cast<std::size_t>(knot)]; unknown >= 0)
        step[unknown] = apart_.series[k].coefficients[knot];
  }
  return step;
}

double SeriesProblem::residual_squares(const VectorXd& step) const {
  return system_.squares + 2.0 * system_.gradient.dot(step) +
         step.dot(system_.matrix.selfadjointView<Eigen::Lower>() * step);
}

double SeriesProblem::effective_number(const Solution& s) const {
  return static_cast<double>(s.step.size()) - prior_.cwiseProduct(s.covariance).sum();
}

double SeriesProblem::effective_number(const Solution& s, std::size_t series) const {
  const SeriesBlock& block = system_.blocks[series];
  return static_cast<double>(block.count) -
         s.covariance.diagonal().segment(block.begin, block.count).sum() / variance_[series];
}

}  // namespace kinfer::calibrate
