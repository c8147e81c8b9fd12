// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/cost.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/continuous/model/bias_process.hpp"
#include "kinfer/estimate/continuous/model/interval_motion.hpp"
#include "kinfer/estimate/continuous/solver/block_residual.hpp"
#include "kinfer/estimate/continuous/solver/fact_residuals.hpp"
#include "kinfer/estimate/continuous/solver/spline_prior.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;
constexpr Index item_intervals = 8;  // per work item; fixed, so that sums do not depend on the number of threads

Index items_of(const InsProblem& problem) {
  return (problem.grid.intervals + item_intervals - 1) / item_intervals;
}

std::pair<Index, Index> intervals_of(const InsProblem& problem, Index item) {
  return {item * item_intervals, std::min(problem.grid.intervals, (item + 1) * item_intervals)};
}

/// Projection of a block's residual on a constant offset of the measurements [sigma], per axis.
std::array<float, 3> offset_of(const InsBlock& block, const BlockResidual& r) {
  std::array<float, 3> offset{};
  const Eigen::Matrix<double, block_nodes, 1> by_offset = block.factor.cast<double>().rowwise().sum();
  const double size = by_offset.norm();
  for (std::size_t axis = 0; axis < 3; ++axis)
    offset[axis] =
        size > 0.0 ? static_cast<float>(by_offset.dot(r.col(static_cast<Index>(axis))) / size) : no_measurement;
  return offset;
}

void accumulate(InstrumentFit& fit, const InsBlock& block, const BlockResidual& r, const RobustBlock& value) {
  const double terms = 3.0 * block.rows;
  fit.squares += value.weight * r.squaredNorm();
  fit.terms += value.weight * terms;
  fit.block.push_back(terms > 0.0 ? static_cast<float>(r.squaredNorm() / terms) : no_measurement);
  fit.offset.push_back(offset_of(block, r));
}

InsCost item_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, Index item,
                  const std::array<SplineBasis, block_nodes>& bases) {
  InsCost cost{.total = 0.0, .sensors = std::vector<SensorFit>(problem.sensors.size())};
  const auto [first, end] = intervals_of(problem, item);
  for (Index interval = first; interval < end; ++interval) {
    std::array<std::vector<InsState>, block_nodes> states;
    for (std::size_t n = 0; n < block_nodes; ++n) states[n] = body_states(problem, layout, x, interval, bases[n]);
    for (std::size_t b = 0; b < x.bodies.size(); ++b) {
      if (x.bodies[b].sensor < 0) continue;
      const auto sensor = static_cast<std::size_t>(x.bodies[b].sensor);
      const InsErrors errors = errors_at(problem, x, sensor, interval);
      for (std::size_t n = 0; n < block_nodes; ++n)
        states[n][b] = sensor_state_at(problem, layout, x, sensor, interval, n, states[n][b]);
      for (const InstrumentMeasurements& use : instruments(problem, sensor)) {
        const InsBlock& block = use.blocks[static_cast<std::size_t>(interval)];
        BlockResidual predicted;
        for (std::size_t n = 0; n < block_nodes; ++n)
          predicted.row(static_cast<Index>(n)) = use.read(states[n][b], errors).transpose();
        const double shift = clock_shift(problem, layout, errors, interval);
        BlockResidual r = residual(block, shifted_factor(block, layout, shift), predicted, use.sd);
        drop_satisfied(r, use, interval);
        const RobustBlock value = robust(r.squaredNorm(), 3.0 * block.rows);
        cost.total += value.cost;
        if (use.is_bound()) continue;  // a satisfied bound says nothing about the noise
        SensorFit& fit = cost.sensors[sensor];
        accumulate(use.state_row == rate_row ? fit.angular_velocity : fit.force, block, r, value);
      }
    }
    each_spline_prior(problem, layout, x.spline_coefficients, interval, [&](const SplinePriorTerm& term) {
      cost.total += term.value * term.value / (term.sd * term.sd);
    });
  }
  return cost;
}

/// `all`: number of intervals of the recording; reserved at once, so that an hour's data are not held twice.
void append(InstrumentFit& to, const InstrumentFit& more, std::size_t all) {
  to.block.reserve(all);
  to.offset.reserve(all);
  to.squares += more.squares;
  to.terms += more.terms;
  to.block.insert(to.block.end(), more.block.begin(), more.block.end());
  to.offset.insert(to.offset.end(), more.offset.begin(), more.offset.end());
}

}  // namespace

InsCost cost_of(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, int threads) {
  const auto bases = node_bases(problem.grid);
  std::vector<InsCost> items(static_cast<std::size_t>(items_of(problem)));
  parallel_for(items.size(), threads,
               [&](std::size_t i) { items[i] = item_cost(problem, layout, x, static_cast<Index>(i), bases); });
  InsCost sum{.total = global_parameter_prior(problem, layout, x).cost + fact_cost(problem, layout, x) +
                       bias_process_cost(problem, layout, x),
              .sensors = std::vector<SensorFit>(problem.sensors.size())};
  const auto all = static_cast<std::size_t>(problem.grid.intervals);
  for (InsCost& item : items) {
    sum.total += item.total;
    for (std::size_t s = 0; s < sum.sensors.size(); ++s) {
      append(sum.sensors[s].angular_velocity, item.sensors[s].angular_velocity, all);
      append(sum.sensors[s].force, item.sensors[s].force, all);
    }
    item = {};
  }
  return sum;
}

}  // namespace kinfer
