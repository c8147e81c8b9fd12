// SPDX-License-Identifier: Apache-2.0
// Levenberg-Marquardt iteration on any source of linearisations: step, damping, termination. Internal to search.
//
// A Source is
//   struct Point { VectorXd x; double cost; bool linearised; ... };
//   void evaluate(Point&, bool linearise);                 cost at x (infinite where it is not finite), counted
//   NormalEquations normal(const Point&);                  of the linearised point, weighted
//   VectorXd fallback_step(const NormalEquations& scaled, const VectorXd& scale, double damping);   Cholesky failed
//   static constexpr bool is_linearisation_cheap;      the cost alone is hardly cheaper than the linearisation
//   static constexpr bool needs_final_linearisation;   the linearisation at the solution is part of the result
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kinfer/base/observer.hpp"
#include "kinfer/base/stop.hpp"
#include "kinfer/linalg/normal_equations.hpp"
#include "kinfer/search/least_squares/options.hpp"

namespace kinfer::search {

inline constexpr double rounding = std::numeric_limits<double>::epsilon();
// Of the largest curvature; keeps a step finite where the curvature vanishes.
inline constexpr double min_damping = 1e-14;
inline constexpr double max_damping = 1e20;        // above, a step no longer changes any unknown
inline constexpr double min_damping_factor = 0.1;  // of the damping, after a step with the predicted decrease

template <class Source>
class LevenbergMarquardt {
 public:
  using Point = typename Source::Point;

  LevenbergMarquardt(Source& source, ConstVectorRef start, const LeastSquaresOptions& options)
      : source_(source), options_(options), damping_(options.initial_damping) {
    current_.x = start;
    source_.evaluate(current_, true);
    history_.push_back(current_.cost);
    if (!finite()) return;
    start_norm_ = std::sqrt(source_.plain_cost(current_));
    column_norms_ = VectorXd::Zero(start.size());
    linearise();
    largest_length_ = options.scale ? std::sqrt(static_cast<double>(start.size())) : 0.0;
    largest_length_ = std::max(largest_length_, scaled(current_.x).norm());
  }

  /// Iterates until a termination criterion holds.
  Stop run(const Observer& observer) {
    if (!finite()) return Stop::not_finite;
    std::optional<Stop> reason = termination_at_point();
    while (!reason) {
      if (iterations_ >= options_.max_iterations) return Stop::budget_spent;
      if (notify(observer, progress()) == ObserverDecision::stop) return Stop::cancelled;
      reason = iterate();
      if (!reason) reason = termination_at_point();
    }
    return *reason;
  }

  Point& best() { return current_; }
  int iterations() const { return iterations_; }
  std::vector<double>& history() { return history_; }

 private:
  bool finite() const { return std::isfinite(current_.cost); }
  VectorXd scaled(const VectorXd& x) const { return x.cwiseQuotient(scale_); }

  Progress progress() const {
    Progress progress;
    progress.stage = "fit";
    progress.fraction = static_cast<double>(iterations_) / options_.max_iterations;
    progress.best = progress.median = current_.cost;
    progress.iteration = iterations_;
    return progress;
  }

  /// Termination criteria that hold at a point, without a step.
  std::optional<Stop> termination_at_point() const {
    if (gradient_is_zero()) return Stop::converged_gradient;
    if (current_.cost <= options_.target_cost) return Stop::target_reached;
    return std::nullopt;
  }

  /// Tries one damped step and accepts it if the cost falls.
  std::optional<Stop> iterate() {
    ++iterations_;
    const double mu = damping_ * largest_curvature_;
    const VectorXd dy = solve(mu);
    const double predicted_decrease = -normal_.gradient.dot(dy) + mu * dy.squaredNorm();
    const bool is_damped = damping_ >= 1.0 || damping_growth_ > 2.0;  // a short step then does not indicate convergence
    if (options_.final_step == FinalStep::skipped && !is_damped && last_step_succeeded_ && iterations_ > 1 &&
        predicted_decrease <= options_.cost_tolerance * current_.cost) {
      history_.push_back(current_.cost);
      return Stop::converged_cost;
    }
    const double noise = cost_noise();
    const double decrease = try_step(dy);
    if (decrease > 0.0) {
      decrease_damping(decrease / predicted_decrease);
    } else {
      increase_damping();
    }
    history_.push_back(current_.cost);
    if (!current_.linearised) return Stop::target_reached;
    if (damping_ > max_damping) return Stop::stalled;
    if (is_damped) return std::nullopt;
    if (decrease > 0.0 ? std::max(decrease, predicted_decrease) <= options_.cost_tolerance * current_.cost
                       : predicted_decrease <= noise)
      return Stop::converged_cost;
    if (dy.norm() <= options_.step_tolerance * largest_length_) return Stop::converged_step;
    return std::nullopt;
  }

  /// Linearises at the current point, in scaled unknowns dy = dx / scale.
  void linearise() {
    normal_ = source_.normal(current_);
    residual_norm_ = std::sqrt(source_.weighted_cost(current_));
    const VectorXd norms = normal_.matrix.diagonal().cwiseSqrt();
    image_norm_ = norms.cwiseProduct(current_.x).norm();
    column_norms_ = column_norms_.cwiseMax(norms);
    scale_ = options_.scale ? *options_.scale : scales_of(column_norms_);
    normal_.matrix = scale_.asDiagonal() * normal_.matrix * scale_.asDiagonal();
    normal_.gradient.array() *= scale_.array();
    largest_curvature_ = normal_.matrix.diagonal().maxCoeff();
  }

  /// Reciprocal of the column norms. A column that is zero to rounding would be scaled up to a spurious direction: it
  /// gets the scale of the largest column, so that its unknown does not move.
  static VectorXd scales_of(const VectorXd& norms) {
    constexpr double min_relative_norm = 1e-13;
    const double largest = norms.maxCoeff();
    if (largest == 0.0) return VectorXd::Ones(norms.size());
    return (norms.array() > min_relative_norm * largest).select(1.0 / norms.array(), 1.0 / largest);
  }

  /// The step in scaled unknowns.
  VectorXd solve(double mu) {
    if (auto step = solve_damped_by_cholesky(normal_, mu)) return *std::move(step);
    return source_.fallback_step(normal_, scale_, mu);
  }

  /// Where no further step follows, the linearisation is skipped.
  bool can_skip_linearisation(double cost) const {
    return !Source::needs_final_linearisation && options_.target_cost > 0.0 && cost <= options_.target_cost;
  }

  /// Decrease of the cost by the step, which is accepted if it is positive.
  double try_step(const VectorXd& dy) {
    trial_.x = current_.x + dy.cwiseProduct(scale_);
    // Linearising at once is cheaper than a second call, as long as steps succeed.
    source_.evaluate(trial_, Source::is_linearisation_cheap && last_step_succeeded_);
    if (trial_.cost < current_.cost && !trial_.linearised && !can_skip_linearisation(trial_.cost))
      source_.evaluate(trial_, true);
    const double decrease = current_.cost - trial_.cost;
    if (decrease > 0.0) std::swap(current_, trial_);
    last_step_succeeded_ = decrease > 0.0;
    return decrease;
  }

  /// After an accepted step: the closer the decrease to the predicted one, the less damping next time (Nielsen 1999).
  void decrease_damping(double gain_ratio) {
    damping_ *= std::max(min_damping_factor, 1.0 - std::pow(2.0 * std::min(gain_ratio, 1.0) - 1.0, 3));
    damping_ = std::max(damping_, min_damping);
    damping_growth_ = 2.0;
    if (!current_.linearised) return;
    linearise();
    largest_length_ = std::max(largest_length_, scaled(current_.x).norm());
  }

  /// After a rejected step: ever faster growth of the damping.
  void increase_damping() {
    damping_ *= damping_growth_;
    damping_growth_ *= 2.0;
  }

  /// Change of the cost by rounding alone. The residuals are differences of numbers as large as J x and as the
  /// residuals of the start, so they are accurate to about `noise` only.
  double cost_noise() const {
    const double noise = rounding * (image_norm_ + start_norm_);
    return 2.0 * residual_norm_ * noise + noise * noise;
  }

  bool gradient_is_zero() const {
    const VectorXd limits = options_.gradient_tolerance * residual_norm_ * normal_.matrix.diagonal().cwiseSqrt();
    return (normal_.gradient.array().abs() <= limits.array()).all();
  }

  Source& source_;
  const LeastSquaresOptions& options_;
  Point current_, trial_;
  NormalEquations normal_;  // in scaled unknowns
  std::vector<double> history_;
  VectorXd scale_, column_norms_;
  double damping_;  // mu as a fraction of the largest curvature
  double damping_growth_ = 2.0;
  double largest_curvature_ = 0.0, residual_norm_ = 0.0, start_norm_ = 0.0, image_norm_ = 0.0, largest_length_ = 0.0;
  int iterations_ = 0;
  bool last_step_succeeded_ = true;
};

}  // namespace kinfer::search
