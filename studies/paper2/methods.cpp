// SPDX-License-Identifier: Apache-2.0
#include "methods.hpp"

#include <chrono>
#include <cmath>

#include "kinfer/calibrate/swarm/swarm_fit.hpp"
#include "kinfer/calibrate/swarm/swarm_fitness.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer::paper2 {
using namespace calibrate;
namespace {

constexpr double papers_sum = 5.55e-5 * 1e-6;  // [m²]

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

double target_sum(const Problem& problem) {
  return static_cast<double>(problem.fit.points.size()) * problem.target_rms * problem.target_rms;
}

Objective objective_of(const Problem& problem) {
  auto fitness = std::make_shared<SwarmFitness>(problem.nominal, problem.parameters, problem.fit);
  return {problem.box, [fitness](ConstMatrixRef x, std::span<double> cost) { fitness->sums(x, cost); }};
}

bool is_noise_free(const Problem& problem) {
  return problem.instrument.sigma == 0.0;
}

Budget budget_of(const Problem& problem, const Effort& effort) {
  return {.max_iterations = effort.max_iterations,
          .target_cost = is_noise_free(problem) ? papers_sum : target_sum(problem),
          .threads = effort.threads};
}

SearchOptions options_of(Method method, const Problem& problem, const Earlier& earlier, Rng rng, const Effort& effort) {
  PsoOptions pso;
  pso.budget = budget_of(problem, effort);
  const MatrixXd even = uniform_swarm(problem.box, pso.particles, rng);
  switch (method) {
    case Method::pso_printed:
      pso.inertia = pso_as_printed().inertia;
      return pso;
    case Method::bpnn_pso:
      pso.initial = clamped(predict(earlier.net, even), problem.box);
      return pso;
    case Method::bpnn_literal:
      // The training after the run is not needed here.
      return BpnnPsoOptions{
          .pso = pso, .net = earlier.net, .use = NetUse::before_every_update, .training = {.epochs = 0}};
    case Method::warm_start:
      pso.initial = draw_warm_swarm(problem.box, pso.particles, earlier.x, rng);
      return pso;
    case Method::draw_compact_swarm:
      pso.initial = draw_compact_swarm(problem.box, pso.particles, rng);
      return pso;
    case Method::qpso:
      return QpsoOptions{.budget = pso.budget};
    default:
      return pso;
  }
}

void evaluate(Trial& trial, const Problem& problem) {
  const Chain found = unpack(problem.parameters, problem.nominal, trial.x);
  trial.fitted = error_statistics(point_errors(found, problem.fit));
  trial.held_out = error_statistics(point_errors(found, problem.verify));
}

Trial search(Method method, const Problem& problem, const Earlier& earlier, int seed, const Effort& effort) {
  const Objective objective = objective_of(problem);
  const SearchOptions options = options_of(method, problem, earlier, Rng(seed).stream(0), effort);
  const Stopwatch watch;
  const SearchOutcome outcome = minimise(objective, options, Rng(seed).stream(1));
  const double seconds = watch.seconds();
  Trial trial{.method = method, .x = outcome.x, .best = outcome.best};
  trial.iterations = iterations_until(outcome.best, target_sum(problem));
  trial.iterations_to_sum = iterations_until(outcome.best, papers_sum);
  const double share = trial.iterations < 0 ? 1.0 : double(trial.iterations + 1) / double(outcome.best.size());
  trial.evaluations = std::llround(share * static_cast<double>(outcome.evaluations));
  trial.seconds = share * seconds;
  if (method == Method::bpnn_pso || method == Method::bpnn_literal) trial.training_seconds = earlier.training_seconds;
  evaluate(trial, problem);
  return trial;
}

Trial least_squares_trial(const Problem& problem) {
  ParameterSet plain = problem.parameters;
  for (Parameter& p : plain.parameters) p.prior_sd = std::numeric_limits<double>::infinity();
  Weights weights;
  weights.of<PointMeasurement>().assign(problem.fit.points.size(), Vec3::Constant(1e-5));
  const Stopwatch watch;
  const LeastSquaresOutcome outcome =
      least_squares(pose_residuals(problem.nominal, plain, problem.fit, weights), pack(plain, problem.nominal));
  Trial trial{.method = Method::lm, .seconds = watch.seconds(), .x = outcome.x};
  for (const double cost : outcome.history) trial.best.push_back(cost * 1e-10);  // back from units of (10 µm)²
  trial.iterations = iterations_until(trial.best, target_sum(problem));
  trial.iterations_to_sum = iterations_until(trial.best, papers_sum);
  trial.evaluations = outcome.evaluations + 24LL * outcome.jacobians;
  evaluate(trial, problem);
  return trial;
}

Trial map_trial(const Problem& problem) {
  const Instrument instrument =
      is_noise_free(problem) ? Instrument{.sigma = 1e-9, .sigma_angle = 0, .ppm = 0} : problem.instrument;
  const Stopwatch watch;
  const Estimate estimate =
      fit_bundle(problem.nominal, problem.parameters, problem.fit, instrument, {.outliers = Outliers::keep_all});
  Trial trial{.method = Method::map_lm, .seconds = watch.seconds(), .x = pack(problem.parameters, estimate.chain)};
  evaluate(trial, problem);
  trial.iterations = trial.fitted.rms <= problem.target_rms ? estimate.search.iterations : -1;
  trial.evaluations = 25LL * estimate.search.evaluations;
  double variance = 0.0;
  for (Eigen::Index row = 0; row < problem.verify.rows(); ++row)
    variance += predicted_covariance(estimate, problem.verify.joints.col(row)).trace();
  trial.predicted_rms = std::sqrt(variance / static_cast<double>(problem.verify.rows()));
  return trial;
}

}  // namespace

std::string name(Method method) {
  constexpr const char* names[] = {
      "PSO as printed (w 0.9)",   "PSO (w 0.8)",   "BPNN-PSO", "BPNN-PSO with the net before every update",
      "warm start without a net", "compact swarm", "QPSO",     "LM",
      "LM with tolerance priors"};
  return names[static_cast<int>(method)];
}

Earlier identify_before(const Problem& problem, int seed) {
  PsoOptions pso;
  pso.budget = budget_of(problem, {});
  const SearchOutcome outcome = particle_swarm(objective_of(problem), pso, Rng(seed).stream(11));
  const Stopwatch watch;
  Mlp net =
      train_on_swarm(problem.box, outcome.initial_swarm, outcome.x, HiddenNodes::figure, {}, 1, Rng(seed).stream(12));
  return {outcome.x, std::move(net), watch.seconds()};
}

Trial run(Method method, const Problem& problem, const Earlier& earlier, int seed, const Effort& effort) {
  if (method == Method::lm) return least_squares_trial(problem);
  if (method == Method::map_lm) return map_trial(problem);
  return search(method, problem, earlier, seed, effort);
}

}  // namespace kinfer::paper2
