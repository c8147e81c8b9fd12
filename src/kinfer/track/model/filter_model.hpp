// SPDX-License-Identifier: Apache-2.0
// What the filter needs of a tracking model: bodies with their considered geometry, sensors with the noise of one
// update, and the processes that drive the states.
#pragma once

#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/track/model/acceleration_process.hpp"
#include "kinfer/track/model/layout.hpp"

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

/// A revolute joint whose zero the identification could not see: an upright one that moved on level ground alone. Its
/// positions are counted by the zero that the model happens to have, which is exact by this definition, and are stated
/// from the start of tracking: that start is a state.
struct UnknownZero {
  Index position = 0, state = 0;  ///< of the filter
};

/// A limb on the first segment beyond an upright axis, which the identification saw turn on level ground alone: that
/// segment's sensor may sit anywhere around the axis, against each limb on its own. Where the ground slopes that
/// matters, and shows.
struct UnknownTurn {
  std::size_t body = 0;     ///< the first of the limb
  std::size_t segment = 0;  ///< its parent
  Index state = 0;
  std::vector<std::size_t> sensors{};  ///< of the limb
};

/// The axis, in the base, of a joint whose zero is unknown. On a base that stood still all beyond the joint may be
/// turned about gravity as it was then: an axis that was not upright lies anywhere on a cone, which is considered where
/// it is narrow, and estimated else. Two states, about the first two axes of the joint's frame on the base. With the
/// zero exact by definition, they take up the turn as well.
struct UnknownAxis {
  std::size_t body = 0;
  Index state = 0;  ///< the first
};

/// Where a joint sits on its parent, of which the identification knows next to nothing: on a base that stood still, or
/// along an upright axis. A base that rocks shows it. Three states.
struct UnknownPoint {
  std::size_t body = 0;
  Index state = 0;  ///< the first
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
  std::vector<UnknownZero> unknown_zeros;
  std::vector<UnknownTurn> unknown_turns;
  std::vector<UnknownAxis> unknown_axes;
  double cone_sd = 0.0;  ///< [rad] of axes on the base that may be anywhere on cones: a turn of its sensor looks alike
  std::vector<UnknownPoint> unknown_points;
  std::vector<JointBranch> joints;  ///< of each joint of the tracking model
  double gravity = standard_gravity;
  InsLevel bias{};                ///< standard deviation of a bias, as its grade has it
  InsLevel bias_walk{};           ///< variance per second of a bias' random walk
  double instability_time = 0.0;  ///< [s] after which a bias has forgotten what it was: it walks no further
  InsLevel power_up{};            ///< variance of a bias' change from one power-up to the next
  MatrixXd parameters;            ///< covariance of sensors' and geometry's states when tracking begins

  /// Whether a body's spherical joint stands for a loose revolute one.
  bool is_loose(std::size_t body) const;
  /// Nothing where the zero of the position is known.
  const UnknownZero* unknown_zero(Index position) const;
  /// Nothing where it is known how the limb that begins with the body is turned on its segment.
  const UnknownTurn* unknown_turn(std::size_t body) const;
  /// Nothing where the axis of the body's joint is known in the base.
  const UnknownAxis* unknown_axis(std::size_t body) const;
  /// Nothing where it is known where the body's joint sits on its parent.
  const UnknownPoint* unknown_point(std::size_t body) const;
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
