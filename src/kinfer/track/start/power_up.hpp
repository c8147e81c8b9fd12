// SPDX-License-Identifier: Apache-2.0
// By how much biases have changed since the identification: not at all, or as a power-up changes them. The first rows
// tell: a joint leaves two of three angular velocities of its sensors fixed to each other, and two of three components
// of gravity, and they agree only with the sensors' own biases. As long as the biases are those of the identification,
// zeros and axes that were found with them hold, too.
#pragma once

#include <span>

#include "kinfer/track/start/initial_posture.hpp"

namespace kinfer::track {

/// Variance of the change, the mean over several sizes of it by the likelihood of the first rows. `posture`: at a time
/// within these. `filter`: before the start.
InsLevel change_of_biases(const FilterModel& model, const ChainFilter& filter, const InitialPosture& posture,
                          std::span<const BlockMeasurement> first_rows);

}  // namespace kinfer::track
