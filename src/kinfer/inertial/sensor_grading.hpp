// SPDX-License-Identifier: Apache-2.0
// Grade of a sensor, estimated from its own recording: noise and bias at rest, resolution and range from its values,
// scale errors from the agreement of gyro and gravity in motion.
#pragma once

#include "kinfer/inertial/rest/rest.hpp"
#include "kinfer/measurement/sensor_model.hpp"

namespace kinfer {

struct SensorStatistics {
  double rest_seconds = 0.0;
  Vec3 rate_density = Vec3::Zero();          ///< [rad/s/√Hz] at rest, from consecutive rows
  Vec3 acceleration_density = Vec3::Zero();  ///< [m/s²/√Hz]
  Vec3 field_density = Vec3::Zero();         ///< [µT/√Hz]
  RestBias gyroscope_bias;                   ///< [rad/s]
  double gravity_error = 0.0;  ///< [m/s²] rms over the rests of |mean specific force| minus standard gravity
  double scale_error = 0.0;    ///< rms of the gyro scale matrix estimated by the smoother; of a long recording, median
                               ///< over its most active minutes
  double rate_resolution = 0.0, acceleration_resolution = 0.0, field_resolution = 0.0;
  double largest_rate = 0.0, largest_acceleration = 0.0;
};
SensorStatistics sensor_statistics(const InsSensor& sensor, std::span<const double> time,
                                   std::span<const RestPeriod> rest_periods);

/// The preset with the highest likelihood, with noise densities as measured at rest. Without any rest: `consumer`, the
/// conservative choice.
SensorModel estimate_sensor_model(const SensorStatistics& sensor_statistics);

/// The worst grade over all sensors of a recording.
SensorModel estimate_sensor_model(const InsRecording& recording);

}  // namespace kinfer
