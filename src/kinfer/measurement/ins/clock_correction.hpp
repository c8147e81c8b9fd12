// SPDX-License-Identifier: Apache-2.0
// Correction of sensor clocks that disagree: offset and drift of each sensor's clock from machine time.
#pragma once

#include <span>

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Maps the time stamps t of one sensor to machine time: t + offset + drift (t − middle).
struct ClockCorrection {
  double offset = 0.0;  ///< [s] at `middle`
  double drift = 0.0;   ///< [s/s]
  double middle = 0.0;  ///< [s] on the sensor's own clock

  double shift_at(double time) const { return offset + drift * (time - middle); }
  bool is_none() const;
};

/// The recording with every sensor on machine time; `corrections`: one per sensor. Sensors of one logger that need the
/// same correction stay together; the others get a logger of their own with the same name.
InsRecording synchronise_sensors(const InsRecording& recording, std::span<const ClockCorrection> corrections);

}  // namespace kinfer
