// Levenberg-Marquardt on a model that someone else linearises: when to step, how far, when to end. Internal to search.
//
// A Source is
//   struct Point { VectorXd x; double cost; bool linearised; ... };
//   void evaluate(Point&, bool linearise);                 cost at x (infinite where it is not finite), counted
//   NormalEquations normal(const Point&);                  of the linearised point, weighted
//   VectorXd step_where_cholesky_fails(const NormalEquations& scaled, const VectorXd& scale, double damping);
//   static constexpr bool linearises_for_little;           so that a step's cost alone is hardly cheaper
//   static constexpr bool is_linearised_at_the_end;        for whoever wants the model where the search ends
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kinfer/base/observer.hpp"
#include "kinfer/linalg/normal_equations.hpp"
#include "kinfer/search/least_squares.hpp"

namespace kinfer::search {

inline constexpr double rounding = std::numeric_limits<double>::epsilon();
// Of the largest curvature; keeps a step finite where the curvature ends.
inline constexpr double least_damping = 1e-14;
inline constexpr double largest_damping = 1e20;    // above, a step no longer changes any unknown
inline constexpr double fastest_relaxation = 0.1;  // of the damping, after a step that did what was forecast

template <class Source>
class Descent {
 public:
  using Point = typename Source::Point;

  Descent(Source& source, ConstVectorRef start, const LeastSquaresOptions& options)
      : source_(source), options_(options), damping_(options.initial_damping) {
    here_.x = start;
    source_.evaluate(here_, true);
    history_.push_back(here_.cost);
    if (!finite()) return;
    start_norm_ = std::sqrt(source_.plain_cost(here_));
    column_norms_ = VectorXd::Zero(start.size());
    linearise();
    largest_length_ = options.scale ? std::sqrt(static_cast<double>(start.size())) : 0.0;
    largest_length_ = std::max(largest_length_, scaled(here_.x).norm());
  }

  /// Runs until there is a reason to end.
  Stop run(const Observer& observer) {
    if (!finite()) return Stop::not_finite;
    std::optional<Stop> reason = arrived();
    while (!reason) {
      if (iterations_ >= options_.max_iterations) return Stop::budget_spent;
      if (tell(observer, progress()) == Wish::stop) return Stop::cancelled;
      reason = iterate();
      if (!reason) reason = arrived();
    }
    return *reason;
  }

  Point& best() { return here_; }
  int iterations() const { return iterations_; }
  std::vector<double>& history() { return history_; }

 private:
  bool finite() const { return std::isfinite(here_.cost); }
  VectorXd scaled(const VectorXd& x) const { return x.cwiseQuotient(scale_); }

  Progress progress() const {
    Progress progress;
    progress.stage = "fit";
    progress.fraction = static_cast<double>(iterations_) / options_.max_iterations;
    progress.best = progress.median = here_.cost;
    progress.iteration = iterations_;
    return progress;
  }

  /// Is this point, as it is, good enough?
  std::optional<Stop> arrived() const {
    if (gradient_is_zero()) return Stop::converged_gradient;
    if (here_.cost <= options_.target_cost) return Stop::target_reached;
    return std::nullopt;
  }

  /// Tries one damped step and takes it where the cost falls.
  std::optional<Stop> iterate() {
    ++iterations_;
    const double mu = damping_ * largest_curvature_;
    const VectorXd dy = solve(mu);
    const double forecast = -normal_.gradient.dot(dy) + mu * dy.squaredNorm();
    const bool shortened = damping_ >= 1.0 || growth_ > 2.0;  // a short step then says nothing about the optimum
    if (options_.last_step == LastStep::saved && !shortened && last_step_succeeded_ && iterations_ > 1 &&
        forecast <= options_.cost_tolerance * here_.cost) {
      history_.push_back(here_.cost);
      return Stop::converged_cost;
    }
    const double noise = cost_noise();
    const double gain = try_step(dy);
    if (gain > 0.0) {
      relax(gain / forecast);
    } else {
      tighten();
    }
    history_.push_back(here_.cost);
    if (!here_.linearised) return Stop::target_reached;
    if (damping_ > largest_damping) return Stop::stalled;
    if (shortened) return std::nullopt;
    if (gain > 0.0 ? std::max(gain, forecast) <= options_.cost_tolerance * here_.cost : forecast <= noise)
      return Stop::converged_cost;
    if (dy.norm() <= options_.step_tolerance * largest_length_) return Stop::converged_step;
    return std::nullopt;
  }

  /// Makes the model at here_, in scaled unknowns dy = dx / scale.
  void linearise() {
    normal_ = source_.normal(here_);
    residual_norm_ = std::sqrt(source_.weighted_cost(here_));
    const VectorXd norms = normal_.matrix.diagonal().cwiseSqrt();
    image_norm_ = norms.cwiseProduct(here_.x).norm();
    column_norms_ = column_norms_.cwiseMax(norms);
    scale_ = options_.scale ? *options_.scale : scales_of(column_norms_);
    normal_.matrix = scale_.asDiagonal() * normal_.matrix * scale_.asDiagonal();
    normal_.gradient.array() *= scale_.array();
    largest_curvature_ = normal_.matrix.diagonal().maxCoeff();
  }

  /// One over the column's norm. A column that is nothing but rounding would be blown up to a direction of its own: it
  /// gets the scale of the largest, by which it moves nothing.
  static VectorXd scales_of(const VectorXd& norms) {
    constexpr double unseen = 1e-13;
    const double largest = norms.maxCoeff();
    if (largest == 0.0) return VectorXd::Ones(norms.size());
    return (norms.array() > unseen * largest).select(1.0 / norms.array(), 1.0 / largest);
  }

  /// The step in scaled unknowns.
  VectorXd solve(double mu) {
    if (auto step = damped_by_cholesky(normal_, mu)) return *std::move(step);
    return source_.step_where_cholesky_fails(normal_, scale_, mu);
  }

  /// No model is made where no further step will be taken.
  bool is_the_end(double cost) const {
    return !Source::is_linearised_at_the_end && options_.target_cost > 0.0 && cost <= options_.target_cost;
  }

  /// How much the cost falls by the step; where it does, the step is taken.
  double try_step(const VectorXd& dy) {
    there_.x = here_.x + dy.cwiseProduct(scale_);
    // A model at once is cheaper than a second call, as long as steps succeed.
    source_.evaluate(there_, Source::linearises_for_little && last_step_succeeded_);
    if (there_.cost < here_.cost && !there_.linearised && !is_the_end(there_.cost)) source_.evaluate(there_, true);
    const double gain = here_.cost - there_.cost;
    if (gain > 0.0) std::swap(here_, there_);
    last_step_succeeded_ = gain > 0.0;
    return gain;
  }

  /// After a step that was taken: the more of the forecast came true, the less damping next time.
  void relax(double came_true) {
    damping_ *= std::max(fastest_relaxation, 1.0 - std::pow(2.0 * std::min(came_true, 1.0) - 1.0, 3));
    damping_ = std::max(damping_, least_damping);
    growth_ = 2.0;
    if (!here_.linearised) return;
    linearise();
    largest_length_ = std::max(largest_length_, scaled(here_.x).norm());
  }

  /// After a step that was refused: ever faster growth of the damping.
  void tighten() {
    damping_ *= growth_;
    growth_ *= 2.0;
  }

  /// What rounding alone may change in the cost. The residuals are differences of numbers as large as J x, and as those
  /// that made the residuals of the start, so they are known to about `noise` only.
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
  Point here_, there_;
  NormalEquations normal_;  // in scaled unknowns
  std::vector<double> history_;
  VectorXd scale_, column_norms_;
  double damping_;  // mu as a fraction of the largest curvature
  double growth_ = 2.0;
  double largest_curvature_ = 0.0, residual_norm_ = 0.0, start_norm_ = 0.0, image_norm_ = 0.0, largest_length_ = 0.0;
  int iterations_ = 0;
  bool last_step_succeeded_ = true;
};

}  // namespace kinfer::search
