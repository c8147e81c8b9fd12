// Clocks of sensors that do not agree: each sensor's time as a straight line of its logger's.
#pragma once

#include <span>

#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

/// What to do to the times of one sensor so that they are those of the machine: t + offset + drift (t − middle).
struct ClockCorrection {
  double offset = 0.0;  ///< [s] at `middle`
  double drift = 0.0;   ///< [s/s]
  double middle = 0.0;  ///< [s] on the sensor's own clock

  double shift_at(double time) const { return offset + drift * (time - middle); }
  bool is_none() const;
};

/// The recording with every sensor on the machine's time; `corrections`: one a sensor. Sensors of one logger that need
/// the same correction stay together; others get a logger of their own with the same name.
InsRecording on_one_clock(const InsRecording& recording, std::span<const ClockCorrection> corrections);

}  // namespace kinfer
