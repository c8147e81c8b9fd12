// Which sensors move when: paper 1's table 3, read off the rates. A still base and a stiff machine make it tell the
// order of the segments; a swaying machine does not.
#pragma once

#include <vector>

#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

struct SensorActivity {
  double rms_rate = 0.0;  ///< [rad/s] without the sensor's bias
  bool moves = false;
};

/// A stretch of time in which the same sensors move.
struct ActivitySpan {
  double begin = 0.0, end = 0.0;        ///< [s]
  std::vector<SensorActivity> sensors;  ///< in the order of the recording
};

struct ActivityOptions {
  double window = 0.5;        ///< [s] over which a sensor counts as moving or not
  double threshold = 8.7e-3;  ///< [rad/s] (0.5 °/s) rms of the rate beyond noise and bias
  double shortest = 1.0;      ///< [s] shorter spans are joined to the one before
};

/// All sensors must share one logger's clock.
std::vector<ActivitySpan> activity(const InsRecording& recording, const ActivityOptions& options = {});

}  // namespace kinfer
