#include "kinfer/estimate/ins_excerpt.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr Index excerpt_windows = 48;   // five minutes
constexpr Index worth_it = 4;           // times as long a recording
constexpr Index silent = spline_order;  // intervals at a window's end that tell nothing, so that splines may jump
constexpr double hardly = 0.1;          // [rad²/s²] sum of squared differences of rates: hardly any turning

/// Size of the mean rate of a block; 0 where nothing was said.
double mean_rate(const InsBlock& block) {
  const auto by_offset = block.factor.rowwise().sum().eval();
  const float square = by_offset.squaredNorm();
  return square > 0.0F ? double{(block.target.transpose() * by_offset).norm() / square} : 0.0;
}

/// The sensor on the nearest body towards the root that has one; −1: none.
int sensor_before(const InsBodies& bodies, std::size_t body) {
  int at = bodies[body].parent;
  while (at >= 0 && bodies[static_cast<std::size_t>(at)].sensor < 0) at = bodies[static_cast<std::size_t>(at)].parent;
  return at < 0 ? -1 : bodies[static_cast<std::size_t>(at)].sensor;
}

/// Turning of each joint (row) in each window (column).
MatrixXd turning_of(const InsProblem& problem, const InsBodies& bodies) {
  const Index windows = problem.grid.intervals / excerpt_window;
  MatrixXd turning = MatrixXd::Zero(static_cast<Index>(bodies.size()), windows);
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    const int before = sensor_before(bodies, b), own = bodies[b].sensor;
    if (before < 0 || own < 0) continue;
    const auto &x = problem.sensors[static_cast<std::size_t>(before)].rate,
               &y = problem.sensors[static_cast<std::size_t>(own)].rate;
    for (Index i = 0; i < windows * excerpt_window; ++i) {
      const auto at = static_cast<std::size_t>(i);
      turning(static_cast<Index>(b), i / excerpt_window) += std::pow(mean_rate(y[at]) - mean_rate(x[at]), 2);
    }
  }
  return turning;
}

/// Window k of an excerpt, its last intervals silenced.
void copy_blocks(const std::vector<InsBlock>& from, Index window, std::vector<InsBlock>& to) {
  if (from.empty()) return;
  const auto first = from.begin() + window * excerpt_window;
  to.insert(to.end(), first, first + (excerpt_window - silent));
  to.insert(to.end(), static_cast<std::size_t>(silent), InsBlock{});
}

}  // namespace

std::vector<Index> telling_windows(const InsProblem& problem, const InsBodies& bodies, Index count) {
  const MatrixXd turning = turning_of(problem, bodies);
  std::vector<bool> taken(static_cast<std::size_t>(turning.cols()), false);
  VectorXd sum = VectorXd::Constant(turning.rows(), hardly);
  std::vector<Index> chosen;
  while (static_cast<Index>(chosen.size()) < std::min(count, turning.cols())) {
    Index best = -1;
    double most = -1.0;
    for (Index k = 0; k < turning.cols(); ++k) {
      if (taken[static_cast<std::size_t>(k)]) continue;
      const double gain = (turning.col(k).array() / sum.array()).log1p().sum();
      if (gain > most) best = k, most = gain;
    }
    taken[static_cast<std::size_t>(best)] = true;
    sum += turning.col(best);
    chosen.push_back(best);
  }
  std::ranges::sort(chosen);
  return chosen;
}

InsExcerpt excerpt_of(const InsProblem& problem, const InsUnknowns& start, const std::vector<Index>& windows) {
  const auto count = static_cast<Index>(windows.size());
  InsExcerpt excerpt{.problem = {.grid = {0.0, problem.grid.period, count * excerpt_window},
                                 .root_stands_still = problem.root_stands_still,
                                 .sensors = {},
                                 .prior = problem.prior,
                                 .wander = problem.wander,
                                 .gravity = problem.gravity,
                                 .gravity_sd = problem.gravity_sd,
                                 .point_sd = problem.point_sd,
                                 .turn_sd = problem.turn_sd,
                                 .anchor = {}},
                     .start = start};
  // Windows that lay far apart in time forget as much of their biases as they did there.
  excerpt.problem.wander.time *=
      static_cast<double>(count * excerpt_window) / static_cast<double>(problem.grid.intervals);
  excerpt.problem.prior.clock_offset = excerpt.problem.prior.clock_drift = 0.0;
  for (const InsReadings& from : problem.sensors) {
    InsReadings to{.rate = {}, .force = {}, .field = {}, .noise = from.noise, .least = from.least};
    for (const Index k : windows) {
      copy_blocks(from.rate, k, to.rate);
      copy_blocks(from.force, k, to.force);
      copy_blocks(from.field, k, to.field);
    }
    excerpt.problem.sensors.push_back(std::move(to));
  }
  excerpt.start.facts = {};
  for (InsErrors& errors : excerpt.start.errors) errors.clock = {};
  excerpt.start.band.resize(start.band.rows(), excerpt.problem.grid.coefficients());
  for (Index i = 0; i < count; ++i) {
    const Index width = excerpt_window + (i + 1 == count ? spline_order - 1 : 0);
    excerpt.start.band.middleCols(i * excerpt_window, width) =
        start.band.middleCols(windows[static_cast<std::size_t>(i)] * excerpt_window, width);
  }
  for (Index joint = problem.root_stands_still ? 0 : 6; joint < start.band.rows(); ++joint)
    excerpt.problem.anchor.push_back(excerpt.start.band(joint, 0));
  return excerpt;
}

bool start_from_excerpt(InsProblem& problem, InsUnknowns& start, const InsFitOptions& options,
                        const Observer& observer) {
  if (problem.grid.intervals < worth_it * excerpt_windows * excerpt_window) return false;
  InsExcerpt excerpt = excerpt_of(problem, start, telling_windows(problem, start.bodies, excerpt_windows));
  const InsFit fit = fit_ins(excerpt.problem, excerpt.start, options, observer);
  start.bodies = fit.unknowns.bodies;
  start.root_force = fit.unknowns.root_force;
  start.root_field = fit.unknowns.root_field;
  for (std::size_t s = 0; s < start.errors.size(); ++s) {
    const InsClock clock = start.errors[s].clock;
    start.errors[s] = fit.unknowns.errors[s];
    start.errors[s].clock = clock;
    problem.sensors[s].noise = excerpt.problem.sensors[s].noise;
  }
  return true;
}

}  // namespace kinfer
