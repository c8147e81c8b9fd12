#include "kinfer/calibrate/population_fit.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/population_fitness.hpp"
#include "kinfer/estimate/bundle.hpp"

namespace kinfer {
namespace {

double half_width(const Parameter& parameter, const PopulationOptions& options) {
  constexpr double tolerances_without_a_width = 5.0;  // gains and compliances: the paper has none
  if (options.box_tolerances > 0.0) return options.box_tolerances * parameter.scale;
  if (parameter.quantity == Quantity::length) return options.box_length;
  if (parameter.quantity == Quantity::angle) return options.box_angle;
  return tolerances_without_a_width * parameter.scale;
}

/// Eq. (11), and where there is a fleet the squares of the distance from its mean in units that the noise weighs.
struct Problem {
  Objective objective;
  std::size_t points = 0;
};

Problem problem_of(const CalibrateTask& task, const PreparedFit& prepared, const PoseSet& rows,
                   const PopulationOptions& options) {
  const auto fitness = std::make_shared<PopulationFitness>(prepared.start, prepared.parameters, rows);
  const VectorXd mean = nominal_of(prepared.parameters);
  const double sigma = task.instrument ? task.instrument->sigma : 0.0;
  const MatrixXd prior =
      task.fleet.empty() ? MatrixXd(0, mean.size()) : MatrixXd(sigma * prior_rows(prepared.parameters));
  const auto evaluate = [fitness, mean, prior](ConstMatrixRef x, std::span<double> cost) {
    fitness->sums(x, cost);
    if (prior.rows() == 0) return;
    for (Eigen::Index i = 0; i < x.cols(); ++i) cost[i] += (prior * (x.col(i) - mean)).squaredNorm();
  };
  return {{search_box(prepared, options), evaluate}, fitness->points()};
}

/// The particles that the earlier calibration asks for; none: the search draws its own.
MatrixXd initial_swarm(const CalibrateTask& task, const PreparedFit& prepared, const Bounds& box, int particles,
                       Rng rng) {
  if (!task.earlier) return {};
  return remembering_swarm(box, particles, pack(prepared.parameters, prepared.start), rng);
}

/// The search with its initial swarm filled in. The net of BPNN-PSO moves evenly drawn particles: it gets no memory.
SearchOptions with_initial_swarm(SearchOptions search, const CalibrateTask& task, const PreparedFit& prepared,
                                 const Bounds& box, Rng rng) {
  if (auto* pso = std::get_if<PsoOptions>(&search))
    pso->initial = initial_swarm(task, prepared, box, pso->particles, rng);
  if (auto* qpso = std::get_if<QpsoOptions>(&search))
    qpso->initial = initial_swarm(task, prepared, box, qpso->particles, rng);
  return search;
}

std::string method_name(const SearchOptions& search) {
  constexpr std::string_view names[] = {"pso", "qpso", "bpnn-pso"};
  return std::string(names[search.index()]);
}

/// What a least-squares fit would say that began and ended at this chain.
Estimate described(const CalibrateTask& task, const PreparedFit& prepared, const PoseSet& rows, ConstVectorRef x) {
  const Chain chain = unpack(prepared.parameters, prepared.start, x);
  return fit_bundle(chain, prepared.parameters, rows, task.instrument,
                    {.max_iterations = 0, .outliers = Outliers::believe_all});
}

Search search_of(const Outcome& outcome, const SearchOptions& options) {
  Search search;
  search.method = method_name(options);
  search.iterations = outcome.iterations;
  search.evaluations = static_cast<int>(outcome.evaluations);
  search.stop = outcome.stop;
  search.cost = outcome.cost;
  search.best = outcome.best;
  search.median = outcome.median;
  if (outcome.net) search.net = mlp_text(*outcome.net);
  return search;
}

double sum_of_squares(const Chain& chain, const PoseSet& rows) {
  double sum = 0.0;
  for (const double error : point_errors(chain, rows)) sum += error * error;
  return sum;
}

Result<void> expect_points(const PoseSet& rows) {
  if (rows.points.empty()) return error("a search by a population needs measured positions (paper 2, eq. 11)");
  return {};
}

}  // namespace

Bounds search_box(const PreparedFit& prepared, const PopulationOptions& options) {
  const std::vector<const Parameter*> free = prepared.parameters.free();
  VectorXd centre(free.size()), half(free.size());
  for (std::size_t k = 0; k < free.size(); ++k) {
    const bool of_the_robot = free[k]->at.owner == Owner::joint;
    centre[k] = of_the_robot ? free[k]->nominal : value_at(prepared.start, free[k]->at);
    half[k] = half_width(*free[k], options);
  }
  return {centre - half, centre + half};
}

Result<Estimate> fit_population(const CalibrateTask& task, const PoseSet& rows, const ParameterChoice& choice,
                                ToleranceScale scale, const PopulationOptions& options, Rng rng,
                                const Observer& observer) {
  if (auto enough = expect_points(rows); !enough) return pass_on(enough.error());
  KINFER_TRY(prepared, prepare_fit(task, rows, choice, scale));
  const Problem problem = problem_of(task, prepared, rows, options);
  const SearchOptions search =
      with_initial_swarm(options.search, task, prepared, problem.objective.bounds, rng.stream(0));
  if (const auto* bpnn = std::get_if<BpnnPsoOptions>(&search))
    if (bpnn->net && bpnn->net->input_box.size() != problem.objective.bounds.size())
      return error("the net of the earlier calibration moves {} parameters, but {} are to be identified",
                   bpnn->net->input_box.size(), problem.objective.bounds.size());
  const Outcome outcome = minimise(problem.objective, search, rng.stream(1), observer);
  Estimate estimate = described(task, prepared, rows, outcome.x);
  estimate.search = search_of(outcome, options.search);
  return estimate;
}

Result<std::vector<SearchRun>> side_by_side(const CalibrateTask& task, const PoseSet& rows,
                                            const ParameterChoice& choice, ToleranceScale scale,
                                            const PopulationOptions& options, const Chain& least_squares, Rng rng,
                                            const Observer& observer) {
  if (auto enough = expect_points(rows); !enough) return pass_on(enough.error());
  KINFER_TRY(prepared, prepare_fit(task, rows, choice, scale));
  const Problem problem = problem_of(task, prepared, rows, options);
  const Bounds& box = problem.objective.bounds;
  const auto* bpnn = std::get_if<BpnnPsoOptions>(&options.search);
  PsoOptions pso = bpnn ? bpnn->pso : PsoOptions{};
  pso.budget.target_cost =
      sum_of_squares(least_squares, rows) + static_cast<double>(problem.points) * papers_excess * papers_excess;

  std::vector<SearchRun> runs;
  const auto run = [&](const std::string& name, const MatrixXd& initial) {
    pso.initial = initial;
    const Outcome outcome = particle_swarm(problem.objective, pso, rng.stream(1), observer);
    runs.push_back({name, iterations_to(outcome.best, pso.budget.target_cost), static_cast<int>(outcome.evaluations),
                    std::sqrt(outcome.cost / static_cast<double>(problem.points))});
  };
  const MatrixXd even = uniform_swarm(box, pso.particles, rng.stream(0));
  run("cold", even);
  run("nominal swarm", compact_swarm(box, pso.particles, rng.stream(0)));
  if (task.earlier)
    run("warm start", remembering_swarm(box, pso.particles, pack(prepared.parameters, prepared.start), rng.stream(0)));
  if (bpnn && bpnn->net) run("net", predict(*bpnn->net, even));
  return runs;
}

MatrixXd compact_swarm(const Bounds& box, int particles, Rng rng) {
  constexpr double width = 0.1;  // of the box
  const VectorXd centre = box.center();
  return (width * (uniform_swarm(box, particles, rng).colwise() - centre)).colwise() + centre;
}

MatrixXd remembering_swarm(const Bounds& box, int particles, ConstVectorRef remembered, Rng rng) {
  MatrixXd swarm = uniform_swarm(box, particles, rng);
  swarm.col(0) = remembered;
  return swarm;
}

int iterations_to(const std::vector<double>& best, double target) {
  const auto reached = std::find_if(best.begin(), best.end(), [&](double cost) { return cost <= target; });
  return reached == best.end() ? -1 : static_cast<int>(reached - best.begin());
}

}  // namespace kinfer
