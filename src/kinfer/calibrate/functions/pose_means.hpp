// SPDX-License-Identifier: Apache-2.0
// Repeated measurements of a pose as one, their mean: evidence of functions has one noise level for all residuals, and
// what scatters within a pose says nothing of the errors that functions are to explain.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/estimate/poses/noise_level.hpp"

namespace kinfer::calibrate {

/// Each quantity once at each pose.
struct PoseMeans {
  PoseSet rows;
  ExcessNoise excess;       ///< beside the accuracy that the instrument and these rows state
  std::vector<int> of_row;  ///< the row of the data that each of them was
};

/// Means of the residuals of points by `chain`, where they were repeated; of other kinds the first measurement.
/// Everything as it is where nothing was.
PoseMeans pose_means(const Chain& chain, const PoseSet& data, const std::optional<Instrument>& instrument,
                     ExcessNoise excess, int threads = 1);

}  // namespace kinfer::calibrate
