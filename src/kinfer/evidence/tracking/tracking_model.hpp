// SPDX-License-Identifier: Apache-2.0
// What an identification hands over to whoever tracks the machine: the geometry in the sensors' frames, the sensors'
// errors and noise, and the covariance of all of it together. track.toml stores it beside chain.toml.
//
// A sensor on a body with angular velocity ω and specific force f, in its own frame, measures
//   gyroscope (I + S_g) ω + b_g,  accelerometer (I + S_a) f + b_a
// With A = parent_R_axis, B = child_R_axis (axis: their third columns), p and c the joint's point in the parent and in
// the child, and q the joint position:
//   revolute   parent_R_child = A Rz(q) Bᵀ,   parent_p_child = p − parent_R_child c
//   prismatic  parent_R_child = A Bᵀ,         parent_p_child = p + q A e_z − parent_R_child c
//   spherical  parent_R_child = A exp(φ) Bᵀ,  parent_p_child = p − parent_R_child c,  exp(φ) = Rx(q₁) Ry(q₂) Rz(q₃)
//   fixed      parent_R_child = A Bᵀ,         parent_p_child = p − parent_R_child c
// Joint positions are those of the chain in chain.toml, in zero and in sense. A universal joint is two revolute bodies
// in series, the first of them without a sensor.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/constants.hpp"
#include "kinfer/evidence/facts/estimated_joint_type.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// One value for a gyroscope [rad/s], one for an accelerometer [m/s²].
struct InsLevel {
  double rate = 0.0, force = 0.0;
};

struct TrackingSensor {
  std::string name{};
  int body = 0;                                                             ///< whose frame is the sensor's
  Vec3 gyroscope_bias = Vec3::Zero(), accelerometer_bias = Vec3::Zero();    ///< [rad/s], [m/s²]
  Mat3 gyroscope_scale = Mat3::Zero(), accelerometer_scale = Mat3::Zero();  ///< S
  InsLevel noise{};            ///< of one sample, white: the instrument's own
  InsLevel residual{};         ///< of one sample about the chain at full bandwidth; at least the noise
  InsLevel slow_residual{};    ///< white noise per sample with as much power at low frequencies as the residuals
  double sample_period = 0.0;  ///< [s] of the samples that these levels belong to
  Mat3 mount_compliance = Mat3::Zero();  ///< [rad per m/s²] T: the mount tilts by T (f − mean of f); zero: rigid
  double mount_stray = 0.0;              ///< [rad] rms deflection of the mount that T does not explain
  double clock_offset = 0.0, clock_offset_sd = 0.0;  ///< [s] a sample stamped t was taken at t + offset
};

/// Standard deviations of the parameters before the log was seen, of one axis; 0: not estimated.
struct TrackingPrior {
  double rotation = 1.0, point = 3.0;  ///< [rad], [m] of the geometry
  InsLevel bias{}, scale{};            ///< scale: of an element of S, dimensionless
  InsLevel bias_instability{};         ///< of a first-order Gauss-Markov process on top of the constant bias
  double instability_time = 100.0;     ///< [s] its correlation time
};

enum class TrackingMotion { fixed, revolute, prismatic, spherical };
std::string_view name(TrackingMotion motion);   ///< "fixed", ...
int degrees_of_freedom(TrackingMotion motion);  ///< 0, 1, 1, 3

/// A body and the motion that connects it to its parent. Body 0 is the base segment and has no joint.
struct TrackingBody {
  int parent = -1;
  int sensor = -1;  ///< index into TrackingModel::sensors; −1: none
  int joint = -1;   ///< index into TrackingModel::joints; −1: body 0
  TrackingMotion motion = TrackingMotion::fixed;
  Mat3 parent_R_axis = Mat3::Identity(), child_R_axis = Mat3::Identity();  ///< A, B
  Vec3 point_in_parent = Vec3::Zero(), point_in_child = Vec3::Zero();      ///< [m] p, c
};

/// What one joint position did in the log that the chain was identified from; for smoothness and plausibility.
struct TrackingRange {
  double lower = 0.0, upper = 0.0;  ///< [rad] or [m]
  double speed = 0.0;               ///< [1/s] largest
  double acceleration = 0.0;        ///< [1/s²] rms
};

/// A joint: one body, or two of a universal joint.
struct TrackingJoint {
  std::string name{};  ///< of the chain's joint; several positions are "name 1", "name 2", ...
  EstimatedJointType type = EstimatedJointType::revolute;
  int first_position = 0;  ///< index into q of its first joint position
  int positions = 1;       ///< their number: 0 (rigid) to 3
  double stray =
      0.0;  ///< [rad] rms angle between the two axes of a loose revolute joint, per direction across them; 0: one axis
  double stray_time = 0.0;             ///< [s] correlation time of the stray
  std::vector<TrackingRange> range{};  ///< one for each position; empty: unknown
};

enum class TrackingParameterKind {
  parent_rotation,      ///< A ← A exp(δ e_component), component 0 or 1 (of B also 2, the zero of a revolute joint)
  child_rotation,       ///< B ← B exp(δ e_component)
  point_in_parent,      ///< [m] p
  point_in_child,       ///< [m] c
  gyroscope_bias,       ///< [rad/s]
  accelerometer_bias,   ///< [m/s²]
  gyroscope_scale,      ///< element of S_g, column by column: row + 3 · column
  accelerometer_scale,  ///< of S_a, likewise
};
std::string_view name(TrackingParameterKind kind);  ///< "parent_rotation", ...

/// Standard deviation [SI] that a parameter can have at all: far beyond what any log leaves open.
double largest_deviation(TrackingParameterKind kind);

/// A row and column of the covariance: a parameter of a body (first four kinds) or of a sensor (the others).
struct TrackingParameter {
  TrackingParameterKind kind{};
  int index = 0;      ///< of the body or sensor
  int component = 0;  ///< 0 to 2, of matrices 0 to 8

  bool operator==(const TrackingParameter&) const = default;
};

/// A point on the machine whose pose is wanted.
struct TrackingTool {
  int body = 0;  ///< that carries it
  Pose body_T_tool{};
  Vec3 sd = Vec3::Zero();  ///< [m] of its position, in the body's frame; independent of the covariance below
};

struct TrackingBase {
  bool moved = false;                 ///< in the log that the chain was identified from
  Vec3 force = Vec3::Zero();          ///< [m/s²] specific force in the base sensor's frame, if it did not move
  double angular_acceleration = 0.0;  ///< [rad/s²] rms per axis, if it moved
  double acceleration = 0.0;          ///< [m/s²] rms per axis about gravity, if it moved
};

struct TrackingModel {
  std::vector<TrackingSensor> sensors;
  std::vector<TrackingBody> bodies;  ///< parents before children
  std::vector<TrackingJoint> joints;
  TrackingPrior prior{};
  TrackingBase base{};
  double gravity = standard_gravity;  ///< [m/s²]
  double gravity_sd = 0.03;
  TrackingTool tool{};
  std::vector<TrackingParameter> parameters;  ///< the covariance's rows, in order
  MatrixXd covariance;                        ///< SI, positive semidefinite, model errors included
  int positions() const;                      ///< length of q
};

/// Names of the joint positions, in the order of q; they are those of the chain's active joints.
std::vector<std::string> position_names(const TrackingModel& model);

/// Combinations of parameters that the log leaves unobservable, one unit column each in units of the prior's standard
/// deviations: their variance is more than half of the prior's.
MatrixXd hidden_directions(const TrackingModel& model);

/// Standard deviations far beyond a turn or the size of a machine say no more than that nothing is known: they are
/// limited to a tenth of the largest possible ones (10 rad, 10 km), the correlations kept.
TrackingModel with_limited_deviations(TrackingModel model);

/// Aborts (programming error) unless indices are in range, parents precede children and sizes agree.
void expect_well_formed(const TrackingModel& model);

}  // namespace kinfer
