// SPDX-License-Identifier: Apache-2.0
// Linear interpolation over short gaps of a sensor, so that a filter can integrate across them.
#pragma once

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Missing or spiked rates and missing, clipped or spiked specific forces are replaced by linear interpolation between
/// the valid measurements on both sides, and their fault bits are cleared, where these are at most `longest` [s] apart.
InsSensor bridge_gaps(const InsSensor& sensor, std::span<const double> time, double longest);

}  // namespace kinfer
