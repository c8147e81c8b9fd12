// SPDX-License-Identifier: Apache-2.0
// Residual of one instrument's measurements in one interval and its robust weight, including clock error and mount
// compliance.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer {

/// [s] from the middle of the grid to that of an interval.
double from_middle(const SplineGrid& grid, Eigen::Index interval);

using BlockResidual = Eigen::Matrix<double, block_nodes, 3>;  // whitened; unused rows are zero

/// (measurements − factor · predictions at the nodes) / sd.
BlockResidual residual(const InsBlock& block, const NodeMatrix& factor, const BlockResidual& predicted, double sd);

/// True time minus logged time of a sensor's measurements, in units of the interval.
double clock_shift(const InsProblem& problem, const InsLayout& layout, const InsErrors& errors, Eigen::Index interval);

/// R (I + shift D): maps values at the nodes to a block's rows, to first order in a small time shift.
NodeMatrix shifted_factor(const InsBlock& block, const InsLayout& layout, double shift);

/// Robust cost and weight of a sum of `terms` squares: logarithmic beyond the χ² mean plus 4 standard deviations.
struct RobustBlock {
  double cost = 0.0, weight = 1.0;
};
RobustBlock robust(double squares, double terms);

/// One instrument of a sensor.
struct InstrumentMeasurements {
  const std::vector<InsBlock>& blocks;
  double sd;
  Vec3 (*read)(const InsState&, const InsErrors&);
  Eigen::Index state_row;                                                     ///< its first row in the state
  const std::vector<std::array<ClippedSides, block_nodes>>* sides = nullptr;  ///< of each block, if these are bounds

  bool is_bound() const { return sides != nullptr; }
};

/// Whether a residual, measured − predicted, is that of a bound that the prediction satisfies.
inline bool is_satisfied(std::int8_t side, double residual) {
  return side != 0 && side * residual <= 0.0;
}

/// Sets the residuals of satisfied bounds to 0; nothing to do for measurements.
void drop_satisfied(BlockResidual& residual, const InstrumentMeasurements& instrument, Eigen::Index interval);

std::vector<InstrumentMeasurements> instruments(const InsProblem& problem, std::size_t sensor);

/// State of the INS at a node, with the compliance of its mount.
InsState sensor_state_at(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, std::size_t sensor,
                         Eigen::Index interval, std::size_t node, const InsState& segment);

}  // namespace kinfer
