#include "kinfer/estimate/ins_band_prior.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;
using SplineWeights = Eigen::Matrix<double, spline_order, 1>;

/// Sd of the third difference of a channel's coefficients: [unit/s³] times period cubed. Far above what shaking hands
/// do: it only bridges stretches in which nothing was said.
double roughness_sd(const InsProblem& problem, Index channel) {
  constexpr double joint = 3e4, root_rate = 1e6, root_force = 1e7;
  const double h = problem.grid.period, cubed = h * h * h;
  if (problem.root_stands_still || channel >= 6) return joint * cubed;
  return (channel < 3 ? root_rate : root_force) * cubed;
}

constexpr double anchor_sd = 3.0;  // [rad] or [m]

}  // namespace

void each_band_prior(const InsProblem& problem, const InsLayout& layout, ConstMatrixRef band, Index interval,
                     const std::function<void(const BandPriorTerm&)>& visit) {
  const bool last = interval + 1 == problem.grid.intervals;
  for (Index channel = 0; channel < layout.channels; ++channel) {
    const double sd = roughness_sd(problem, channel);
    for (Index shift = 0; shift <= (last ? 2 : 0); ++shift) {
      SplineWeights weights = SplineWeights::Zero();
      weights.segment<4>(shift) << -1.0, 3.0, -3.0, 1.0;
      visit({channel, weights, weights.dot(band.row(channel).segment<spline_order>(interval).transpose()), sd});
    }
    const Index joint = channel - (problem.root_stands_still ? 0 : 6);
    if (interval == 0 && joint >= 0) {
      const double start = problem.anchor.empty() ? 0.0 : problem.anchor[static_cast<std::size_t>(joint)];
      visit({channel, SplineWeights::Unit(0), band(channel, 0) - start, anchor_sd});
    }
  }
}

}  // namespace kinfer
