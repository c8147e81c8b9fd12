// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/swarm/swarm_fit.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/swarm/swarm_fitness.hpp"
#include "kinfer/estimate/poses/bundle.hpp"

namespace kinfer::calibrate {
namespace {

constexpr double other_half_width = 5.0;  // [tolerances] of gains and compliances: not in the paper
constexpr double compact_width = 0.1;     // [1] of the box

double half_width(const Parameter& parameter, const SearchBox& box) {
  if (const auto* tolerances = std::get_if<ToleranceBox>(&box)) return tolerances->tolerances * parameter.scale;
  const AbsoluteBox& absolute = std::get<AbsoluteBox>(box);
  if (parameter.quantity == Quantity::length) return absolute.length;
  if (parameter.quantity == Quantity::angle) return absolute.angle;
  return other_half_width * parameter.scale;
}

/// Eq. (11), plus the prior's squares (scaled by the measurement variance) where there is a population prior.
struct Problem {
  Objective objective;
  std::size_t points = 0;
};

Problem make_problem(const CalibrationTask& task, const PreparedFit& prepared, const PoseSet& rows,
                     const SwarmSearchOptions& options) {
  const auto fitness = std::make_shared<SwarmFitness>(prepared.start, prepared.parameters, rows);
  const VectorXd mean = nominal_of(prepared.parameters);
  const double sigma = task.instrument ? task.instrument->sigma : 0.0;
  const MatrixXd prior = task.has_population() ? MatrixXd(sigma * prior_sqrt_information_of(prepared.parameters))
                                               : MatrixXd(0, mean.size());
  const auto evaluate = [fitness, mean, prior](ConstMatrixRef x, std::span<double> cost) {
    fitness->sums(x, cost);
    if (prior.rows() == 0) return;
    for (Eigen::Index i = 0; i < x.cols(); ++i) cost[i] += (prior * (x.col(i) - mean)).squaredNorm();
  };
  return {{make_search_box(prepared, options), evaluate}, fitness->points()};
}

/// An initial swarm that contains the earlier calibration; empty without one: the search draws its own.
MatrixXd draw_initial_swarm(const CalibrationTask& task, const PreparedFit& prepared, const Bounds& box, int particles,
                            Rng rng) {
  if (!task.earlier) return {};
  return draw_warm_swarm(box, particles, pack(prepared.parameters, prepared.start), rng);
}

/// The search with its initial swarm filled in, if it takes one.
SearchOptions with_initial_swarm(SearchOptions search, const CalibrationTask& task, const PreparedFit& prepared,
                                 const Bounds& box, Rng rng) {
  const SwarmMethod& method = method_of(search);
  if (method.takes_initial_swarm)
    method.initial(search) = draw_initial_swarm(task, prepared, box, method.particles(search), rng);
  return search;
}

/// The estimate that a least-squares fit without any iteration returns at x: covariance, errors and identifiability.
Estimate estimate_at(const CalibrationTask& task, const PreparedFit& prepared, const PoseSet& rows, ConstVectorRef x) {
  const Chain chain = unpack(prepared.parameters, prepared.start, x);
  return fit_bundle(chain, prepared.parameters, rows, task.instrument,
                    {.max_iterations = 0, .outliers = Outliers::keep_all});
}

SearchSummary summarise_search(const SearchOutcome& outcome, const SearchOptions& options) {
  SearchSummary search;
  search.method = method(options);
  search.iterations = outcome.iterations;
  search.evaluations = static_cast<int>(outcome.evaluations);
  search.stop = outcome.stop;
  search.cost = outcome.cost;
  search.best = outcome.best;
  search.median = outcome.median;
  if (outcome.net) search.net = format_mlp(*outcome.net);
  return search;
}

double sum_of_squares(const Chain& chain, const PoseSet& rows) {
  double sum = 0.0;
  for (const double error : point_errors(chain, rows)) sum += error * error;
  return sum;
}

Result<void> require_points(const PoseSet& rows) {
  if (rows.points.empty()) return error("a swarm search needs measured positions (paper 2, eq. 11)");
  return {};
}

}  // namespace

Bounds make_search_box(const PreparedFit& prepared, const SwarmSearchOptions& options) {
  const std::vector<const Parameter*> free = prepared.parameters.free();
  VectorXd centre(free.size()), half(free.size());
  for (std::size_t k = 0; k < free.size(); ++k) {
    centre[k] = is_joint_parameter(free[k]->at) ? free[k]->nominal : value_at(prepared.start, free[k]->at);
    half[k] = half_width(*free[k], options.box);
  }
  return {centre - half, centre + half};
}

Result<Estimate> fit_by_swarm(const CalibrationTask& task, const PoseSet& rows, const ParameterChoice& choice,
                              ToleranceScale scale, const SwarmSearchOptions& options, Rng rng,
                              const Observer& observer) {
  if (auto enough = require_points(rows); !enough) return forward_error(enough.error());
  KINFER_TRY(prepared, prepare_fit(task, rows, choice, scale));
  const Problem problem = make_problem(task, prepared, rows, options);
  const SearchOptions search =
      with_initial_swarm(options.search, task, prepared, problem.objective.bounds, rng.stream(0));
  if (const auto* bpnn = std::get_if<BpnnPsoOptions>(&search))
    if (bpnn->net && bpnn->net->input_box.size() != problem.objective.bounds.size())
      return error("the network of the earlier calibration has {} parameters, but {} are to be identified",
                   bpnn->net->input_box.size(), problem.objective.bounds.size());
  const SearchOutcome outcome = minimise(problem.objective, search, rng.stream(1), observer);
  Estimate estimate = estimate_at(task, prepared, rows, outcome.x);
  estimate.search = summarise_search(outcome, options.search);
  return estimate;
}

Result<std::vector<SearchRun>> swarm_comparison(const CalibrationTask& task, const PoseSet& rows,
                                                const ParameterChoice& choice, ToleranceScale scale,
                                                const SwarmSearchOptions& options, const Chain& least_squares, Rng rng,
                                                const Observer& observer) {
  if (auto enough = require_points(rows); !enough) return forward_error(enough.error());
  KINFER_TRY(prepared, prepare_fit(task, rows, choice, scale));
  const Problem problem = make_problem(task, prepared, rows, options);
  const Bounds& box = problem.objective.bounds;
  const auto* bpnn = std::get_if<BpnnPsoOptions>(&options.search);
  PsoOptions pso = bpnn ? bpnn->pso : PsoOptions{};
  pso.budget.target_cost =
      sum_of_squares(least_squares, rows) + static_cast<double>(problem.points) * paper_excess * paper_excess;

  std::vector<SearchRun> runs;
  const auto run = [&](InitialSwarm swarm, const MatrixXd& initial) {
    pso.initial = initial;
    const SearchOutcome outcome = particle_swarm(problem.objective, pso, rng.stream(1), observer);
    runs.push_back({swarm, iterations_until(outcome.best, pso.budget.target_cost),
                    static_cast<int>(outcome.evaluations),
                    std::sqrt(outcome.cost / static_cast<double>(problem.points))});
  };
  const MatrixXd uniform = uniform_swarm(box, pso.particles, rng.stream(0));
  run(InitialSwarm::uniform, uniform);
  run(InitialSwarm::compact, draw_compact_swarm(box, pso.particles, rng.stream(0)));
  if (task.earlier)
    run(InitialSwarm::warm,
        draw_warm_swarm(box, pso.particles, pack(prepared.parameters, prepared.start), rng.stream(0)));
  if (bpnn && bpnn->net) run(InitialSwarm::network, predict(*bpnn->net, uniform));
  return runs;
}

MatrixXd draw_compact_swarm(const Bounds& box, int particles, Rng rng) {
  const VectorXd centre = box.center();
  return (compact_width * (uniform_swarm(box, particles, rng).colwise() - centre)).colwise() + centre;
}

MatrixXd draw_warm_swarm(const Bounds& box, int particles, ConstVectorRef known, Rng rng) {
  MatrixXd swarm = uniform_swarm(box, particles, rng);
  swarm.col(0) = known;
  return swarm;
}

int iterations_until(const std::vector<double>& best, double target) {
  const auto reached = std::find_if(best.begin(), best.end(), [&](double cost) { return cost <= target; });
  return reached == best.end() ? -1 : static_cast<int>(reached - best.begin());
}

}  // namespace kinfer::calibrate
