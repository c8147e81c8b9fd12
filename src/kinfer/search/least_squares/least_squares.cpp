// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/least_squares/least_squares.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include "kinfer/base/expect.hpp"
#include "kinfer/search/least_squares/levenberg_marquardt.hpp"

namespace kinfer {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

void check(Eigen::Index unknowns, ConstVectorRef start, const LeastSquaresOptions& options) {
  KINFER_EXPECT(unknowns > 0, "{} unknowns", unknowns);
  KINFER_EXPECT(start.size() == unknowns, "{} values for {} unknowns", start.size(), unknowns);
  KINFER_EXPECT(options.loss_scale > 0.0 && options.initial_damping > 0.0);
  if (options.scale) {
    KINFER_EXPECT(options.scale->size() == unknowns && (options.scale->array() > 0.0).all());
  }
}

/// Source of residuals and dense Jacobian, with robust weights computed here.
class DenseSource {
 public:
  static constexpr bool is_linearisation_cheap = true, needs_final_linearisation = true;

  struct Point {
    VectorXd x, r;
    MatrixXd jacobian;
    bool linearised = false;
    double cost = infinite;
    VectorXd weights;  // one per block
  };

  DenseSource(const Residuals& problem, const LeastSquaresOptions& options) : problem_(problem), options_(options) {}

  void evaluate(Point& at, bool linearise) {
    at.r.resize(problem_.rows);
    if (linearise) at.jacobian.resize(problem_.rows, problem_.unknowns);
    problem_.evaluate(at.x, at.r, linearise ? &at.jacobian : nullptr);
    KINFER_EXPECT(at.r.size() == problem_.rows, "{} residuals of {}", at.r.size(), problem_.rows);
    at.linearised = linearise;
    ++counts.evaluations;
    if (linearise) ++counts.jacobians;
    at.cost = at.r.allFinite() && (!linearise || at.jacobian.allFinite()) ? apply_loss(at) : infinite;
    if (!std::isfinite(at.cost)) ++counts.not_finite;
  }

  double plain_cost(const Point& at) const { return at.r.squaredNorm(); }
  double weighted_cost(const Point&) const { return r().squaredNorm(); }

  NormalEquations normal(const Point& at) {
    current_ = &at;
    singular_.reset();
    if (options_.loss != Loss::none) {
      const VectorXd root = root_weights(at);
      weighted_jacobian_.noalias() = root.asDiagonal() * at.jacobian;
      weighted_r_ = root.cwiseProduct(at.r);
    }
    return normal_equations(jacobian(), r());
  }

  /// By the singular values of the Jacobian in scaled unknowns, which are computed once per point.
  VectorXd fallback_step(const NormalEquations&, const VectorXd& scale, double damping) {
    if (!singular_) singular_ = singular_system(jacobian() * scale.asDiagonal(), r());
    return solve_damped_by_svd(*singular_, damping);
  }

  EvaluationCounts counts;

 private:
  /// Sets the weight of each block; returns the cost.
  double apply_loss(Point& at) const {
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

  /// Square root of the weight of each row: that of its block, 1 for the rows after the blocks.
  VectorXd root_weights(const Point& at) const {
    VectorXd root = VectorXd::Ones(problem_.rows);
    Eigen::Index row = 0;
    for (std::size_t b = 0; b < problem_.blocks.size(); row += problem_.blocks[b++])
      root.segment(row, problem_.blocks[b]).setConstant(std::sqrt(at.weights[static_cast<Eigen::Index>(b)]));
    return root;
  }

  const MatrixXd& jacobian() const { return options_.loss == Loss::none ? current_->jacobian : weighted_jacobian_; }
  const VectorXd& r() const { return options_.loss == Loss::none ? current_->r : weighted_r_; }

  const Residuals& problem_;
  const LeastSquaresOptions& options_;
  const Point* current_ = nullptr;          // the point that was linearised last
  std::optional<SingularSystem> singular_;  // of its Jacobian and residuals, if Cholesky failed there
  MatrixXd weighted_jacobian_;              // of it, where there is a loss
  VectorXd weighted_r_;
};

/// Source of normal equations that the problem computes itself.
class NormalSource {
 public:
  static constexpr bool is_linearisation_cheap = false, needs_final_linearisation = false;

  struct Point {
    VectorXd x;
    NormalEquations normal;
    bool linearised = false;
    double cost = infinite;
  };

  explicit NormalSource(const NormalProblem& problem) : problem_(problem) {}

  void evaluate(Point& at, bool linearise) {
    at.cost = linearise ? problem_.linearise(at.x, at.normal) : problem_.cost(at.x);
    at.linearised = linearise;
    ++counts.evaluations;
    if (linearise) ++counts.jacobians;
    if (!std::isfinite(at.cost) || (linearise && !at.normal.gradient.allFinite()))
      at.cost = infinite, ++counts.not_finite;
  }

  double plain_cost(const Point& at) const { return at.cost; }
  double weighted_cost(const Point& at) const { return at.cost; }
  NormalEquations normal(const Point& at) const { return at.normal; }

  /// By the eigenvalues; directions that JᵀJ does not resolve get a zero step.
  VectorXd fallback_step(const NormalEquations& scaled, const VectorXd&, double damping) const {
    return solve_damped_by_eigenvalues(scaled, damping);
  }

  EvaluationCounts counts;

 private:
  const NormalProblem& problem_;
};

template <class Source>
LeastSquaresOutcome outcome_of(search::LevenbergMarquardt<Source>& solver, Source& source, Stop stop) {
  LeastSquaresOutcome outcome;
  outcome.x = std::move(solver.best().x);
  outcome.cost = solver.best().cost;
  outcome.history = std::move(solver.history());
  outcome.stop = stop;
  outcome.iterations = solver.iterations();
  outcome.evaluations = source.counts.evaluations;
  outcome.jacobians = source.counts.jacobians;
  outcome.not_finite = source.counts.not_finite;
  return outcome;
}

}  // namespace

LeastSquaresOutcome least_squares(const Residuals& problem, ConstVectorRef start, const LeastSquaresOptions& options,
                                  const Observer& observer) {
  check(problem.unknowns, start, options);
  const auto in_blocks = std::accumulate(problem.blocks.begin(), problem.blocks.end(), Eigen::Index{0});
  KINFER_EXPECT(problem.rows > 0 && in_blocks <= problem.rows, "{} rows in blocks, {} in all", in_blocks, problem.rows);
  DenseSource source(problem, options);
  search::LevenbergMarquardt solver(source, start, options);
  const Stop stop = solver.run(observer);
  LeastSquaresOutcome outcome = outcome_of(solver, source, stop);
  outcome.residuals = std::move(solver.best().r);
  outcome.jacobian = std::move(solver.best().jacobian);
  outcome.block_weights = std::move(solver.best().weights);
  return outcome;
}

LeastSquaresOutcome least_squares(const NormalProblem& problem, ConstVectorRef start,
                                  const LeastSquaresOptions& options, const Observer& observer) {
  check(problem.unknowns, start, options);
  KINFER_EXPECT(options.loss == Loss::none, "robust weights belong into the problem's own normal equations");
  NormalSource source(problem);
  search::LevenbergMarquardt solver(source, start, options);
  const Stop stop = solver.run(observer);
  LeastSquaresOutcome outcome = outcome_of(solver, source, stop);
  if (solver.best().linearised) outcome.normal = std::move(solver.best().normal);
  return outcome;
}

}  // namespace kinfer
