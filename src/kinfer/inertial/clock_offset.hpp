// SPDX-License-Identifier: Apache-2.0
// Clock offset between two loggers from the angular speed of their sensors: segments of one machine move together.
#pragma once

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

struct ClockOffset {
  double seconds = 0.0;  ///< to be added to the other logger's times to obtain the reference's
  double correlation =
      0.0;  ///< of the two best matching sensors, 0 .. 1; accepted above inertial::min_logger_correlation
};

/// The lag at which the magnitude of the angular rate of any sensor of one logger correlates best with that of any
/// sensor of the other: first all lags with at least 10 s of overlap at 2 Hz, then those near the best at 50 Hz, then
/// the vertex of a parabola. Accurate to a few milliseconds where both see the same rotations.
ClockOffset estimate_clock_offset(const InsRecording& recording, std::size_t reference, std::size_t other);

}  // namespace kinfer
