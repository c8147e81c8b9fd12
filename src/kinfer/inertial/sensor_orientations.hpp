// SPDX-License-Identifier: Apache-2.0
// Orientations of the sensors of a recording from a filter.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/inertial/filters/orientation.hpp"
#include "kinfer/measurement/ins/sensor_orientations.hpp"

namespace kinfer {

/// One entry per index in `sensors`. Short gaps are bridged as for identification, unless the filter is causal: it gets
/// the rows as they were recorded. An error for a sensor without any specific force.
Result<std::vector<SensorOrientations>> estimate_orientations(const InsRecording& recording,
                                                              std::span<const std::size_t> sensors,
                                                              const FilterOptions& options);

}  // namespace kinfer
