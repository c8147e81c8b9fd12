// SPDX-License-Identifier: Apache-2.0
// The state of a chain with its sensors, and how it and the covariance of its error change with time.
#pragma once

#include "kinfer/track/model/filter_model.hpp"

namespace kinfer::track {

struct SensorErrors {
  Vec3 gyroscope_bias = Vec3::Zero(), accelerometer_bias = Vec3::Zero();
  Mat3 gyroscope_scale = Mat3::Zero(), accelerometer_scale = Mat3::Zero();
};

enum class BaseMode { still, moving };

struct ChainState {
  double time = 0.0;  ///< [s]
  BaseMode base = BaseMode::still;
  Mat3 world_R_base = Mat3::Identity();
  Vec3 rate = Vec3::Zero(), angular_acceleration = Vec3::Zero();  ///< of the base sensor's frame
  Vec3 velocity = Vec3::Zero(), acceleration = Vec3::Zero();      ///< of its origin, in the world
  VectorXd joints;              ///< q, q̇, q̈ of each joint position; q of spherical joints is 0
  VectorXd liveliness;          ///< of each joint position: mean square of q̈ over `liveliness_time`
  VectorXd start;               ///< [rad] of each joint position: subtracted from q where its zero is unknown
  VectorXd turned;              ///< [rad] of each body: its joint, about the axis of its parent's
  std::vector<Mat3> tilted;     ///< of each body: its axis, in the frame of its parent
  std::vector<Vec3> moved;      ///< [m] of each body: its joint on its parent, from where the model has it
  std::vector<Mat3> spherical;  ///< of each body: exp(φ); the identity unless spherical
  std::vector<SensorErrors> sensors;

  /// Motion of the base, as the chain propagates it.
  InsState base_state(double gravity) const;
};

/// At rest at joint position 0 with the sensors' errors of the model.
ChainState initial_state(const FilterModel& model);

/// Where a body's joint sits in the frame of its parent, A and p, and by which the limb's turn rotates both against the
/// model's: about the axis as the model has it, which is off by less than a milliradian.
struct ParentSide {
  Mat3 parent_R_axis;
  Vec3 point_in_parent;
  Mat3 turn = Mat3::Identity();
};
ParentSide parent_side(const FilterModel& model, const ChainState& state, std::size_t body);

/// The model with the turns of segments that are in the state.
FilterModel turned_model(const FilterModel& model, const ChainState& state);

/// Adds an error to the estimated states; those of the geometry are left alone.
void retract(const FilterModel& model, const VectorXd& error, ChainState& state);

/// What the blocks before and after a step show as means: of all joints the rates, or (a sensor is lost) of those alone
/// that have nothing else the accelerations.
enum class ShownMeans { rates, accelerations };

/// The mean after `dt` seconds.
void predict_mean(const FilterModel& model, double dt, ChainState& state, ShownMeans means = ShownMeans::rates);

/// Errors of the state (a row each, of the estimated states) after `dt` seconds; `state` is that before.
void predict_error(const FilterModel& model, const ChainState& state, double dt, MatrixXd& errors,
                   ShownMeans means = ShownMeans::rates);

/// Biases wander for `dt` seconds, as their instability says: added to the error state's covariance.
void add_bias_walk(const FilterModel& model, double dt, MatrixXd& covariance);

/// The error state's covariance (symmetric) after `dt` seconds, at most `longest_step`; `state` is that before.
void predict_covariance(const FilterModel& model, const ChainState& state, double dt, MatrixXd& covariance,
                        ShownMeans means = ShownMeans::rates);

}  // namespace kinfer::track
