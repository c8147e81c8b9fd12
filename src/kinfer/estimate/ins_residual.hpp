// One instrument's readings in one interval: what is left of them, how much it is believed, and where the sensor's
// clock and mount come in.
#pragma once

#include "kinfer/estimate/ins_problem.hpp"

namespace kinfer {

/// [s] of an interval's middle after the grid's.
double from_middle(const SplineGrid& grid, Eigen::Index interval);

using BlockResidual = Eigen::Matrix<double, block_nodes, 3>;  // whitened; unused rows are zero

/// (readings − factor · predicted at the nodes) / sd.
BlockResidual residual(const InsBlock& block, const NodeMatrix& factor, const BlockResidual& predicted, double sd);

/// Where a sensor's clock puts the truth that it shows, less where it logs it, in intervals.
double clock_shift(const InsProblem& problem, const InsLayout& layout, const InsErrors& errors, Eigen::Index interval);

/// What a block's rows are of the values at the nodes when these are carried on by a small shift: R (I + shift D).
NodeMatrix shifted_factor(const InsBlock& block, const InsLayout& layout, double shift);

/// Cost and weight of so many squared terms; beyond chance (χ² + 4 sd) the cost grows as a logarithm.
struct RobustBlock {
  double cost = 0.0, weight = 1.0;
};
RobustBlock robust(double squares, double terms);

/// One instrument of a sensor.
struct InstrumentUse {
  const std::vector<InsBlock>& blocks;
  double sd;
  Vec3 (*read)(const InsState&, const InsErrors&);
  Eigen::Index state_row;  ///< first row of it in the state
};
std::vector<InstrumentUse> instruments(const InsProblem& problem, const InsLayout& layout, std::size_t sensor);

/// What the INS feels at a node, on the mount that it has.
InsState felt_at(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, std::size_t sensor,
                 Eigen::Index interval, std::size_t node, const InsState& segment);

}  // namespace kinfer
