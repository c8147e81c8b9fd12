// SPDX-License-Identifier: Apache-2.0
// Clipped measurements of one instrument within the intervals of the time grid. On a clipped axis a sample is a bound:
// a residual only where the prediction is inside the range.
//
// A bound cannot be compressed like a measurement, because whether it acts depends on the prediction. So up to
// block_nodes groups of consecutive samples are kept in each interval, each a row at its mean time with the weight of
// its samples; the axes that are not clipped enter in the same row as measurements.
#pragma once

#include "kinfer/estimate/continuous/model/measurement_blocks.hpp"
#include "kinfer/measurement/ins/clipping.hpp"

namespace kinfer {

struct InsClippedBlocks {
  std::vector<InsBlock> blocks;                              ///< one per interval; empty: nothing is clipped
  std::vector<std::array<ClippedSides, block_nodes>> sides;  ///< of each block's rows

  bool empty() const { return blocks.empty(); }
};

/// Of gyroscope or accelerometer; `time`, `grid` and `clock_offset` as of ins_blocks.
InsClippedBlocks clipped_blocks(const InsSensor& sensor, std::span<const double> time, InsInstrument instrument,
                                const SplineGrid& grid, double clock_offset = 0.0);

}  // namespace kinfer
