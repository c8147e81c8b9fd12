#include "kinfer/search/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/normal_equations.hpp"

namespace kinfer {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();
// Of the largest curvature; keeps a step finite where the curvature ends.
constexpr double least_damping = 1e-14;
constexpr double largest_damping = 1e20;    // above, a step no longer changes any unknown
constexpr double fastest_relaxation = 0.1;  // of the damping, after a step that did what was forecast
constexpr double infinite = std::numeric_limits<double>::infinity();

struct Point {
  VectorXd x, r;
  MatrixXd jacobian;
  bool has_jacobian = false;
  double cost = infinite;
  VectorXd weights;  // one per block
};

/// The weighted linear model |J dx + r|² around a point, and the unknowns' scales that go with it.
struct Model {
  NormalEquations normal;                    // in scaled unknowns dy = dx / scale
  std::optional<SingularSystem> singular{};  // of J and r in scaled unknowns, made where the normal equations do not do
  double largest_curvature = 0.0;
  double residual_norm = 0.0;
};

void check(const Residuals& problem, ConstVectorRef start, const LeastSquaresOptions& options) {
  const auto in_blocks = std::accumulate(problem.blocks.begin(), problem.blocks.end(), Eigen::Index{0});
  KINFER_EXPECT(problem.unknowns > 0 && problem.rows > 0, "{} unknowns, {} rows", problem.unknowns, problem.rows);
  KINFER_EXPECT(in_blocks <= problem.rows, "{} rows in blocks, {} in all", in_blocks, problem.rows);
  KINFER_EXPECT(start.size() == problem.unknowns, "{} values for {} unknowns", start.size(), problem.unknowns);
  KINFER_EXPECT(options.loss_scale > 0.0 && options.initial_damping > 0.0);
  if (options.scale) {
    KINFER_EXPECT(options.scale->size() == problem.unknowns && (options.scale->array() > 0.0).all());
  }
}

class Descent {
 public:
  Descent(const Residuals& problem, ConstVectorRef start, const LeastSquaresOptions& options)
      : problem_(problem), options_(options), damping_(options.initial_damping) {
    here_.x = start;
    evaluate(here_, true);
    outcome_.history.push_back(here_.cost);
    if (!finite()) return;
    start_norm_ = here_.r.norm();
    column_norms_ = VectorXd::Zero(problem.unknowns);
    linearise();
    largest_length_ = options.scale ? std::sqrt(static_cast<double>(problem.unknowns)) : 0.0;
    largest_length_ = std::max(largest_length_, scaled(here_.x).norm());
  }

  bool finite() const { return std::isfinite(here_.cost); }
  int iterations() const { return outcome_.iterations; }

  Progress progress() const {
    Progress progress;
    progress.stage = "fit";
    progress.fraction = static_cast<double>(outcome_.iterations) / options_.max_iterations;
    progress.best = progress.median = here_.cost;
    progress.iteration = outcome_.iterations;
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
    ++outcome_.iterations;
    const double mu = damping_ * model_.largest_curvature;
    const VectorXd dy = solve(mu);
    const double forecast = -model_.normal.gradient.dot(dy) + mu * dy.squaredNorm();
    const bool shortened = damping_ >= 1.0 || growth_ > 2.0;  // a short step then says nothing about the optimum
    const double noise = cost_noise();
    const double gain = try_step(dy);
    if (gain > 0.0) {
      relax(gain / forecast);
    } else {
      tighten();
    }
    outcome_.history.push_back(here_.cost);
    if (damping_ > largest_damping) return Stop::stalled;
    if (shortened) return std::nullopt;
    if (gain > 0.0 ? std::max(gain, forecast) <= options_.cost_tolerance * here_.cost : forecast <= noise)
      return Stop::converged_cost;
    if (dy.norm() <= options_.step_tolerance * largest_length_) return Stop::converged_step;
    return std::nullopt;
  }

  LeastSquaresOutcome outcome(Stop stop) && {
    outcome_.x = std::move(here_.x);
    outcome_.cost = here_.cost;
    outcome_.residuals = std::move(here_.r);
    outcome_.jacobian = std::move(here_.jacobian);
    outcome_.block_weights = std::move(here_.weights);
    outcome_.stop = stop;
    return std::move(outcome_);
  }

 private:
  VectorXd scaled(const VectorXd& x) const { return x.cwiseQuotient(scale_); }

  void evaluate(Point& at, bool with_jacobian) {
    at.r.resize(problem_.rows);
    if (with_jacobian) at.jacobian.resize(problem_.rows, problem_.unknowns);
    problem_.evaluate(at.x, at.r, with_jacobian ? &at.jacobian : nullptr);
    KINFER_EXPECT(at.r.size() == problem_.rows, "{} residuals of {}", at.r.size(), problem_.rows);
    at.has_jacobian = with_jacobian;
    ++outcome_.evaluations;
    if (with_jacobian) ++outcome_.jacobians;
    at.cost = at.r.allFinite() && (!with_jacobian || at.jacobian.allFinite()) ? weigh(at) : infinite;
    if (!std::isfinite(at.cost)) ++outcome_.not_finite;
  }

  /// Sets the weight of each block; returns the cost.
  double weigh(Point& at) const {
    at.weights.resize(static_cast<Eigen::Index>(problem_.blocks.size()));
    double cost = 0.0;
    Eigen::Index row = 0;
    for (std::size_t b = 0; b < problem_.blocks.size(); ++b) {
      const int size = problem_.blocks[b];
      const auto [rho, weight] = loss_value(options_.loss, at.r.segment(row, size).squaredNorm(),
                                            options_.loss_scale * std::sqrt(static_cast<double>(size)));
      cost += rho;
      at.weights[static_cast<Eigen::Index>(b)] = weight;
      row += size;
    }
    return cost + at.r.tail(problem_.rows - row).squaredNorm();
  }

  /// Multiplies the rows of each block by the root of its weight.
  void apply_weights(MatrixXd& jacobian, VectorXd& r) const {
    Eigen::Index row = 0;
    for (std::size_t b = 0; b < problem_.blocks.size(); ++b) {
      const int size = problem_.blocks[b];
      const double root = std::sqrt(here_.weights[static_cast<Eigen::Index>(b)]);
      jacobian.middleRows(row, size) *= root;
      r.segment(row, size) *= root;
      row += size;
    }
  }

  /// Makes the model at here_ from its residuals and Jacobian.
  void linearise() {
    if (options_.loss != Loss::none) {
      weighted_jacobian_ = here_.jacobian;
      weighted_r_ = here_.r;
      apply_weights(weighted_jacobian_, weighted_r_);
    }
    model_ = {normal_equations(jacobian(), r()), std::nullopt, 0.0, r().norm()};
    const VectorXd norms = model_.normal.matrix.diagonal().cwiseSqrt();
    image_norm_ = norms.cwiseProduct(here_.x).norm();
    column_norms_ = column_norms_.cwiseMax(norms);
    scale_ = options_.scale ? *options_.scale
                            : VectorXd((column_norms_.array() > 0.0).select(1.0 / column_norms_.array(), 1.0));
    model_.normal.matrix = scale_.asDiagonal() * model_.normal.matrix * scale_.asDiagonal();
    model_.normal.gradient.array() *= scale_.array();
    model_.largest_curvature = model_.normal.matrix.diagonal().maxCoeff();
  }

  const MatrixXd& jacobian() const { return options_.loss == Loss::none ? here_.jacobian : weighted_jacobian_; }
  const VectorXd& r() const { return options_.loss == Loss::none ? here_.r : weighted_r_; }

  /// The step in scaled unknowns.
  VectorXd solve(double mu) {
    if (const auto step = damped_by_cholesky(model_.normal, mu)) return *step;
    if (!model_.singular) model_.singular = singular_system(jacobian() * scale_.asDiagonal(), r());
    return damped_by_svd(*model_.singular, mu);
  }

  /// How much the cost falls by the step; where it does, the step is taken.
  double try_step(const VectorXd& dy) {
    there_.x = here_.x + dy.cwiseProduct(scale_);
    // A Jacobian at once is cheaper than a second call, as long as steps succeed.
    evaluate(there_, last_step_succeeded_);
    if (there_.cost < here_.cost && !there_.has_jacobian) evaluate(there_, true);
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
    return 2.0 * model_.residual_norm * noise + noise * noise;
  }

  bool gradient_is_zero() const {
    const VectorXd limits =
        options_.gradient_tolerance * model_.residual_norm * model_.normal.matrix.diagonal().cwiseSqrt();
    return (model_.normal.gradient.array().abs() <= limits.array()).all();
  }

  const Residuals& problem_;
  const LeastSquaresOptions& options_;
  LeastSquaresOutcome outcome_;
  Point here_, there_;
  Model model_;
  MatrixXd weighted_jacobian_;  // of here_, where there is a loss
  VectorXd weighted_r_;
  VectorXd scale_, column_norms_;
  double damping_;  // mu as a fraction of the largest curvature
  double growth_ = 2.0;
  double start_norm_ = 0.0, image_norm_ = 0.0, largest_length_ = 0.0;
  bool last_step_succeeded_ = true;
};

}  // namespace

LeastSquaresOutcome least_squares(const Residuals& problem, ConstVectorRef start, const LeastSquaresOptions& options,
                                  const Observer& observer) {
  check(problem, start, options);
  Descent descent(problem, start, options);
  if (!descent.finite()) return std::move(descent).outcome(Stop::not_finite);
  std::optional<Stop> reason = descent.arrived();
  while (!reason) {
    if (descent.iterations() >= options.max_iterations) {
      reason = Stop::budget_spent;
    } else if (tell(observer, descent.progress()) == Wish::stop) {
      reason = Stop::cancelled;
    } else {
      reason = descent.iterate();
      if (!reason) reason = descent.arrived();
    }
  }
  return std::move(descent).outcome(*reason);
}

}  // namespace kinfer
