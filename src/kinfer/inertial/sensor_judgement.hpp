// What grade a sensor is, judged from its own recording: noise and bias at rest, resolution and range from its numbers,
// scale errors from how well gyro and gravity agree in motion.
#pragma once

#include "kinfer/inertial/rest.hpp"
#include "kinfer/measurement/sensor_model.hpp"

namespace kinfer {

struct SensorFindings {
  double rest_seconds = 0.0;
  Vec3 rate_density = Vec3::Zero();          ///< [rad/s/√Hz] at rest, from neighbouring rows
  Vec3 acceleration_density = Vec3::Zero();  ///< [m/s²/√Hz]
  Vec3 field_density = Vec3::Zero();         ///< [µT/√Hz]
  RestBias rate_bias;                        ///< [rad/s]
  double gravity_error = 0.0;  ///< [m/s²] rms over the rests of |mean specific force| minus standard gravity
  double scale_error = 0.0;    ///< rms of the gyro's scale matrix as the smoother found it, of a long recording in its
                               ///< liveliest minutes
  double rate_resolution = 0.0, acceleration_resolution = 0.0, field_resolution = 0.0;
  double largest_rate = 0.0, largest_acceleration = 0.0;
};
SensorFindings findings(const InsSensor& sensor, std::span<const double> time, std::span<const Rest> rests);

/// The preset whose figures make the findings most likely, with the noise as found where there were rests.
/// No rest at all: `consumer`, the careful choice.
SensorModel judged_model(const SensorFindings& findings);

/// Both in one, over all sensors of a recording: the worst of their grades.
SensorModel judged_model(const InsRecording& recording);

}  // namespace kinfer
