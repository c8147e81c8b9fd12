// SPDX-License-Identifier: Apache-2.0
// A change of speed with limited acceleration and jerk: the building block of every path.
//
// Jerk +j, 0, −j: the double-S ramp (Biagiotti and Melchiorri 2008, Trajectory Planning for Automatic Machines and
// Robots, section 3.4). Its shape is symmetric, so the mean speed of a ramp is the mean of its ends.
#pragma once

namespace kinfer::motion {

/// Of one coordinate, all > 0: [unit/s], [unit/s²], [unit/s³].
struct MotionLimits {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;
};

struct RampState {
  double position = 0.0;      ///< covered since the ramp began, as a part of (change of speed · duration) [1]
  double speed = 0.0;         ///< part of the change of speed, 0 to 1 [1]
  double acceleration = 0.0;  ///< [1/s]
  double jerk = 0.0;          ///< [1/s²]
};

/// The fastest ramp by one unit of speed.
class SRamp {
 public:
  /// A duration of 0: no change of speed.
  SRamp() = default;
  /// Limits of acceleration and jerk per unit of the change of speed [1/s], [1/s²], > 0.
  SRamp(double acceleration, double jerk);

  double duration() const { return 2.0 * jerk_time_ + constant_time_; }
  RampState at(double t) const;  ///< 0 <= t <= duration

 private:
  double jerk_time_ = 0.0, constant_time_ = 0.0, jerk_ = 0.0;
};

}  // namespace kinfer::motion
