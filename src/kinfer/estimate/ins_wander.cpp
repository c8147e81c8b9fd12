#include "kinfer/estimate/ins_wander.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double perfect_rate = 1e-9, perfect_force = 1e-8;  // [rad/s], [m/s²] where only the other wanders

constexpr Index long_recording = 12288;  // intervals, twenty minutes: from here on half as many ends are worth more

Index length_of_stretch(const SplineGrid& grid) {
  return grid.intervals < long_recording ? 64 : 128;
}

Index count_of(const SplineGrid& grid) {
  return std::max<Index>(1, grid.intervals / length_of_stretch(grid));
}

}  // namespace

std::vector<InsStretch> stretches_of(const SplineGrid& grid) {
  std::vector<InsStretch> stretches;
  const Index count = count_of(grid), length = length_of_stretch(grid);
  for (Index k = 0; k < count; ++k)
    stretches.push_back({k * length, k + 1 == count ? grid.intervals : (k + 1) * length});
  return stretches;
}

Index stretch_at(const SplineGrid& grid, Index interval) {
  return std::min(interval / length_of_stretch(grid), count_of(grid) - 1);
}

InsErrors errors_at(const InsProblem& problem, const InsUnknowns& x, std::size_t sensor, Index interval) {
  InsErrors errors = x.errors[sensor];
  if (x.wander.size() == 0) return errors;
  const auto now = x.wander.col(stretch_at(problem.grid, interval)).segment<6>(6 * static_cast<Index>(sensor));
  errors.rate_bias += now.head<3>();
  errors.force_bias += now.tail<3>();
  return errors;
}

WanderPrior wander_prior(const InsProblem& problem, const InsLayout& layout) {
  const InsWander& wander = problem.wander;
  WanderPrior prior{
      .keep = std::exp(-problem.grid.period * static_cast<double>(length_of_stretch(problem.grid)) / wander.time),
      .information = VectorXd(layout.wander),
      .innovation = {}};
  for (Index at = 0; at < layout.wander; at += 3) {
    const double sd = at % 6 == 0 ? std::max(wander.rate_sd, perfect_rate) : std::max(wander.force_sd, perfect_force);
    prior.information.segment<3>(at).setConstant(1.0 / (sd * sd));
  }
  prior.innovation = prior.information / (1.0 - prior.keep * prior.keep);
  return prior;
}

std::vector<Index> wandering_border(const InsLayout& layout) {
  std::vector<Index> border;
  for (const Index first : layout.error)
    for (Index i = 0; i < 6 && layout.wander > 0; ++i) border.push_back(first + i);
  return border;
}

double wander_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  if (layout.wander == 0) return 0.0;
  const WanderPrior prior = wander_prior(problem, layout);
  double cost = x.wander.col(0).cwiseAbs2().dot(prior.information);
  for (Index k = 1; k < x.wander.cols(); ++k)
    cost += (x.wander.col(k) - prior.keep * x.wander.col(k - 1)).cwiseAbs2().dot(prior.innovation);
  return cost;
}

}  // namespace kinfer
