// SPDX-License-Identifier: Apache-2.0
// Clipped peaks of a sensor, restored from their shoulders, so that a filter integrates about what was turned: with
// the clipped values the orientation would lag behind after every peak.
#pragma once

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Clipped values are replaced by a polynomial through the measurements before and after the peak, never less than the
/// range, and their fault bits are cleared: for filters only, which need a value at every row. Peaks at the ends of the
/// recording keep their values.
InsSensor restore_clipped_peaks(const InsSensor& sensor, std::span<const double> time);

}  // namespace kinfer
