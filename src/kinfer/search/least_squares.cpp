#include "kinfer/search/least_squares.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include "kinfer/base/expect.hpp"
#include "kinfer/search/descent.hpp"

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

/// Residuals and Jacobian as they are, robust weights made here.
class DenseSource {
 public:
  static constexpr bool linearises_for_little = true, is_linearised_at_the_end = true;

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
    at.cost = at.r.allFinite() && (!linearise || at.jacobian.allFinite()) ? weigh(at) : infinite;
    if (!std::isfinite(at.cost)) ++counts.not_finite;
  }

  double plain_cost(const Point& at) const { return at.r.squaredNorm(); }
  double weighted_cost(const Point&) const { return r().squaredNorm(); }

  NormalEquations normal(const Point& at) {
    here_ = &at;
    singular_.reset();
    if (options_.loss != Loss::none) {
      const VectorXd root = root_weights(at);
      weighted_jacobian_.noalias() = root.asDiagonal() * at.jacobian;
      weighted_r_ = root.cwiseProduct(at.r);
    }
    return normal_equations(jacobian(), r());
  }

  /// By the singular values of the Jacobian in scaled unknowns, which are made once a point.
  VectorXd step_where_cholesky_fails(const NormalEquations&, const VectorXd& scale, double damping) {
    if (!singular_) singular_ = singular_system(jacobian() * scale.asDiagonal(), r());
    return damped_by_svd(*singular_, damping);
  }

  EvaluationCounts counts;

 private:
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

  /// The root of each row's weight: of its block, 1 beyond the blocks.
  VectorXd root_weights(const Point& at) const {
    VectorXd root = VectorXd::Ones(problem_.rows);
    Eigen::Index row = 0;
    for (std::size_t b = 0; b < problem_.blocks.size(); row += problem_.blocks[b++])
      root.segment(row, problem_.blocks[b]).setConstant(std::sqrt(at.weights[static_cast<Eigen::Index>(b)]));
    return root;
  }

  const MatrixXd& jacobian() const { return options_.loss == Loss::none ? here_->jacobian : weighted_jacobian_; }
  const VectorXd& r() const { return options_.loss == Loss::none ? here_->r : weighted_r_; }

  const Residuals& problem_;
  const LeastSquaresOptions& options_;
  const Point* here_ = nullptr;             // the point that was linearised last
  std::optional<SingularSystem> singular_;  // of its Jacobian and residuals, made where the normal equations do not do
  MatrixXd weighted_jacobian_;              // of it, where there is a loss
  VectorXd weighted_r_;
};

/// Normal equations that the problem makes itself.
class NormalSource {
 public:
  static constexpr bool linearises_for_little = false, is_linearised_at_the_end = false;

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

  /// By the eigenvalues; what the squared Jacobian no longer resolves gets no step.
  VectorXd step_where_cholesky_fails(const NormalEquations& scaled, const VectorXd&, double damping) const {
    return damped_by_eigenvalues(scaled, damping);
  }

  EvaluationCounts counts;

 private:
  const NormalProblem& problem_;
};

template <class Source>
LeastSquaresOutcome outcome_of(search::Descent<Source>& descent, Source& source, Stop stop) {
  LeastSquaresOutcome outcome;
  outcome.x = std::move(descent.best().x);
  outcome.cost = descent.best().cost;
  outcome.history = std::move(descent.history());
  outcome.stop = stop;
  outcome.iterations = descent.iterations();
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
  search::Descent descent(source, start, options);
  const Stop stop = descent.run(observer);
  LeastSquaresOutcome outcome = outcome_of(descent, source, stop);
  outcome.residuals = std::move(descent.best().r);
  outcome.jacobian = std::move(descent.best().jacobian);
  outcome.block_weights = std::move(descent.best().weights);
  return outcome;
}

LeastSquaresOutcome least_squares(const NormalProblem& problem, ConstVectorRef start,
                                  const LeastSquaresOptions& options, const Observer& observer) {
  check(problem.unknowns, start, options);
  KINFER_EXPECT(options.loss == Loss::none, "robust weights belong into the problem's own normal equations");
  NormalSource source(problem);
  search::Descent descent(source, start, options);
  const Stop stop = descent.run(observer);
  LeastSquaresOutcome outcome = outcome_of(descent, source, stop);
  if (descent.best().linearised) outcome.normal = std::move(descent.best().normal);
  return outcome;
}

}  // namespace kinfer
