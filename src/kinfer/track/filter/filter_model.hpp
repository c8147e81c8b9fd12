// SPDX-License-Identifier: Apache-2.0
// What the filter needs of a tracking model: bodies with their considered geometry, sensors with the noise of one
// update, and the processes that drive the states.
#pragma once

#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/track/filter/acceleration_process.hpp"
#include "kinfer/track/filter/layout.hpp"

namespace kinfer::track {

struct SensorSettings {
  int body = 0;
  Vec3 gyroscope_bias = Vec3::Zero(), accelerometer_bias = Vec3::Zero();
  Mat3 gyroscope_scale = Mat3::Zero(), accelerometer_scale = Mat3::Zero();
  InsLevel white{};       ///< of one sample: averages out
  InsLevel persistent{};  ///< of one update: does not average out within it
  InsLevel slow{};        ///< white noise of one sample as strong as the residuals at low frequencies
  double sample_period = 0.005;
  double axis_sd = 0.0;  ///< [rad] of the directions of joint axes on its segment, which are considered
};

/// A spherical joint that stands for a loose revolute joint: its axes stray from each other.
struct LooseRevoluteJoint {
  std::size_t body = 0;
  double stray = 0.0, time = 0.0;  ///< [rad] per direction, [s]
};

/// Inertial sensors observe the acceleration of a prismatic joint, but hardly its velocity: it moves within the range
/// seen.
struct PrismaticRange {
  Index position = 0;               ///< of the filter
  double middle = 0.0, half = 0.0;  ///< [m]
  double speed = 0.0;               ///< [m/s]
};

/// A revolute joint between two sensors. Where one of them is lost, the rates of the others show the sum of this
/// joint's and the next one's, if their axes are parallel, and only accelerations tell them apart.
struct RevoluteBetweenSensors {
  Index position = 0;  ///< of the filter
  std::size_t parent_sensor = 0, child_sensor = 0;
  double speed = 0.0;  ///< [rad/s] where nothing shows how it moves
};

/// What lies beyond a joint of the tracking model, in the order of the bodies.
struct JointBranch {
  std::vector<std::size_t> bodies{}, sensors{};
};

struct FilterModel {
  InsBodies bodies;
  FilterLayout layout;
  std::vector<SensorSettings> sensors;
  std::vector<AccelerationProcess> positions;  ///< of each joint position of the filter
  AccelerationProcess base_rotation, base_translation;
  std::vector<LooseRevoluteJoint> loose;
  std::vector<PrismaticRange> prismatic;
  std::vector<RevoluteBetweenSensors> revolute;
  std::vector<JointBranch> joints;  ///< of each joint of the tracking model
  double gravity = standard_gravity;
  InsLevel bias{};                ///< standard deviation of a bias, as its grade has it
  InsLevel bias_walk{};           ///< variance per second of a bias' random walk
  double instability_time = 0.0;  ///< [s] after which a bias has forgotten what it was: it walks no further
  InsLevel power_up{};            ///< variance of a bias' change from one power-up to the next
  MatrixXd parameters;            ///< covariance of sensors' and geometry's states when tracking begins

  /// Whether a body's spherical joint stands for a loose revolute one.
  bool is_loose(std::size_t body) const;
};

FilterModel filter_model(const TrackingModel& model);

/// The same with this variance of the change of biases since the identification, beside their instability and what the
/// model is persistently off by.
FilterModel with_power_up(FilterModel model, const InsLevel& variance);

/// Where a joint position of the filter stands in the tracking model: indices into its q and its joints; −1: none.
struct ModelPosition {
  int q = -1, joint = -1;
};

/// Of each position of the filter. A spherical joint that stands for a loose revolute one has its rotation about the
/// axis as the third, and nothing for the others.
std::vector<ModelPosition> model_positions(const TrackingModel& tracking, const FilterModel& model);

}  // namespace kinfer::track
