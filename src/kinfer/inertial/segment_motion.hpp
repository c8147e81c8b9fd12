// SPDX-License-Identifier: Apache-2.0
// Motion of each segment from its INS: orientation from a filter, angular velocity from the gyro, acceleration from
// specific force transformed to the world minus gravity; all on one clock and with the same smoothing.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/constants.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/inertial/filters/orientation.hpp"

namespace kinfer {

/// One entry per row of the common clock. World: x east, y north, z up.
struct SegmentMotion {
  std::string name;                        ///< name of the sensor
  std::vector<Mat3> rotation;              ///< world_R_sensor
  std::vector<Vec3> gyro;                  ///< [rad/s] in the sensor, corrected for known gyro errors, not smoothed
  std::vector<Vec3> angular_velocity;      ///< [rad/s] angular velocity in the world
  std::vector<Vec3> angular_acceleration;  ///< [rad/s²] angular acceleration in the world
  std::vector<Vec3> acceleration;          ///< [m/s²] in the world, eq. (26) of paper 1 minus gravity
  std::vector<double> restarts{};          ///< [s] gaps behind which the heading is another one, ascending
  bool still = false;                      ///< never moved: constant rotation, zero velocity and acceleration
};

struct RecordedMotion {
  std::vector<double> time;             ///< [s] equally spaced
  double period = 0.0;                  ///< [s]
  std::vector<SegmentMotion> segments;  ///< in the order of the recording's sensors
  std::vector<bool> usable;             ///< rows where all sensors have valid measurements within the smoothing kernel
  double gravity = standard_gravity;    ///< [m/s²] that was subtracted from the specific forces
  std::size_t first_motion_row = 0;     ///< row at which the first segment starts to move

  std::size_t rows() const { return time.size(); }
};

/// Names of the segments' sensors, in order.
std::vector<std::string> segment_names(const RecordedMotion& motion);

/// The bias of a gyroscope, told by something else than its rests.
struct GyroscopeBias {
  std::string sensor{};
  Vec3 mean = Vec3::Zero();  ///< [rad/s]
  double sd = 0.0;           ///< [rad/s] of an axis
};

struct SegmentMotionOptions {
  FilterOptions filter = KinferOfflineOptions{};
  double smoothing = 0.02;        ///< [s] standard deviation of the Gaussian; wider attenuates noise and fast motion
  double stationary_rate = 0.02;  ///< [rad/s] smoothed rms below which a sensor may be stationary
  double stationary_acceleration = 0.15;  ///< [m/s²] smoothed rms, likewise; both must hold
  double gravity = standard_gravity;      ///< [m/s²] subtracted from the specific force
  std::vector<GyroscopeBias> biases{};    ///< used for sensors that never rest
};

/// All sensors on the first sensor's clock. An error if there are fewer than two sensors, or a sensor has no usable
/// rates or specific forces. Loggers are assumed to be synchronous.
Result<RecordedMotion> segment_motion(const InsRecording& recording, const SegmentMotionOptions& options = {},
                                      int threads = 0);

/// world_R_sensor on the motion's clock, from the filter of the options.
std::vector<Mat3> segment_rotations(const RecordedMotion& motion, const InsRecording& recording,
                                    const InsSensor& sensor, const SegmentMotionOptions& options);

}  // namespace kinfer
