// SPDX-License-Identifier: Apache-2.0
// Which sensors move when (paper 1, table 3), from the angular rates. With a stationary base and a stiff machine this
// gives the order of the segments; with a swaying machine it does not.
#pragma once

#include <vector>

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

struct SensorActivity {
  double rms_rate = 0.0;  ///< [rad/s] after removal of the bias
  bool moves = false;
};

/// A time segment in which the same sensors move.
struct ActivitySpan {
  double begin = 0.0, end = 0.0;        ///< [s]
  std::vector<SensorActivity> sensors;  ///< in the order of the recording
};

struct ActivityOptions {
  double window = 0.5;        ///< [s] over which a sensor is classified as moving or stationary
  double threshold = 8.7e-3;  ///< [rad/s] (0.5 °/s) rms rate, bias removed, above which it moves
  double shortest = 1.0;      ///< [s] shorter spans are merged with the preceding one
};

/// All sensors must share one logger's clock.
std::vector<ActivitySpan> detect_activity(const InsRecording& recording, const ActivityOptions& options = {});

}  // namespace kinfer
