// How each segment moved, as its INS tells: orientation from a filter, rates from the gyro, accelerations from specific
// force turned to the ground and freed of gravity; all on one clock, all through the same smoothing.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/inertial/orientation.hpp"

namespace kinfer {

/// One entry a row of the common clock. Ground: x east, y north, z up.
struct SegmentMotion {
  std::string name;                ///< of the sensor
  std::vector<Mat3> rotation;      ///< ground_R_sensor
  std::vector<Vec3> gyro;          ///< [rad/s] in the sensor, its errors as far as known taken off, not smoothed
  std::vector<Vec3> rate;          ///< [rad/s] in the ground
  std::vector<Vec3> rate_change;   ///< [rad/s²] in the ground
  std::vector<Vec3> acceleration;  ///< [m/s²] in the ground, eq. (26) of paper 1 less gravity
  bool still = false;              ///< never moved: rotation is constant, rates and acceleration are zero
};

struct RecordedMotion {
  std::vector<double> time;             ///< [s] equally spaced
  double period = 0.0;                  ///< [s]
  std::vector<SegmentMotion> segments;  ///< in the order of the recording's sensors
  std::vector<bool> usable;             ///< rows at which every sensor has sound readings within the smoothing's reach
  std::size_t first_motion = 0;         ///< row at which the first segment begins to move

  std::size_t rows() const { return time.size(); }
};

/// Names of the segments' sensors, in their order.
std::vector<std::string> segment_names(const RecordedMotion& motion);

struct SegmentMotionOptions {
  FilterOptions filter = KinferOfflineOptions{};
  double smoothing = 0.02;           ///< [s] standard deviation of the Gaussian; wider damps noise and fast motion
  double still_rate = 0.02;          ///< [rad/s] rms, smoothed: a sensor that never turns faster may stand still
  double still_acceleration = 0.15;  ///< [m/s²] rms, smoothed: nor is accelerated more
  double gravity = 9.81;             ///< [m/s²]
};

/// All sensors on the first sensor's clock. An error where there are fewer than two sensors, or a sensor has no usable
/// rates or specific forces. Loggers are taken as synchronous.
Result<RecordedMotion> segment_motion(const InsRecording& recording, const SegmentMotionOptions& options = {},
                                      int threads = 0);

/// ground_R_sensor on the motion's clock as the options' filter has it.
std::vector<Mat3> segment_rotations(const RecordedMotion& motion, const InsRecording& recording,
                                    const InsSensor& sensor, const SegmentMotionOptions& options);

}  // namespace kinfer
