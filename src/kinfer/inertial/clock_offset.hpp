// How far the clocks of two loggers are apart, from how much their sensors turn: segments of one machine move together.
#pragma once

#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

struct ClockOffset {
  double seconds = 0.0;      ///< to add to the other logger's times so that they are those of the reference
  double correlation = 0.0;  ///< of the two best matching sensors' rates, 0 .. 1; below 0.5 do not trust it
};

/// By the lag at which the size of the angular rate of any sensor of one logger correlates best with that of any sensor
/// of the other: all lags with 10 s of overlap at 2 Hz first, then near the best at 50 Hz, then the vertex of a
/// parabola. Good to a few milliseconds where the same turns are seen by both.
ClockOffset clock_offset(const InsRecording& recording, std::size_t reference, std::size_t other);

}  // namespace kinfer
