// SPDX-License-Identifier: Apache-2.0
// Sensors on bodies that move freely, on wheels and on a stick: recordings without a machine.
#pragma once

#include <functional>
#include <string>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::study {

/// Pose of a body in the world at a time [s].
using BodyMotion = std::function<Pose(double time)>;

struct FreeSensor {
  std::string name;
  BodyMotion motion;
  double gyro_gain = 1.0, accelerometer_gain = 1.0;
};

/// What sensors of this grade measure; 100 Hz.
InsRecording record_free_sensors(const std::vector<FreeSensor>& sensors, double seconds, const std::string& grade,
                                 Rng rng);

/// A body moved at random, without any relation to others: 4 s rest, then waves of 0.2 to 1.5 Hz.
BodyMotion random_motion(Rng rng);

/// The trunk of a running body: bounces and sways at the pace [Hz], drifts forward.
BodyMotion running_trunk(double pace, Rng rng);

/// A segment that swings about the trunk at its pace and its harmonics, in all six directions: it shares no joint.
BodyMotion loose_segment(const BodyMotion& trunk, double pace, Rng rng);

/// A sensor on wheel `index` of a car, off its axle; all wheels of one car have the same `car`.
BodyMotion wheel_of_car(Rng car, std::size_t index, Rng wheel);

/// Fixed to another body at a random pose.
BodyMotion fixed_on(const BodyMotion& body, Rng rng);

}  // namespace kinfer::study
