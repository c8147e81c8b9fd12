// SPDX-License-Identifier: Apache-2.0
// Joint positions of a robot and the external measurements of each pose.
//
// One row per pose; each kind of measurement is a list of its own that refers to rows, so a new instrument is a new
// list.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kinfer/geometry/pose.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// Position of the tool point (target −1) or of a further target on the tool, in the world frame.
struct PointMeasurement {
  int row = 0;
  int target = -1;               ///< index into PoseSet::targets; −1: the tool point
  Vec3 position = Vec3::Zero();  ///< [m]
  std::optional<Vec3> sd;        ///< [m] along `axes`, where the file gives it
  std::optional<Mat3> axes{};    ///< columns: directions in the world, orthonormal; none: the world's axes
};

/// Orientation of the tool in the world frame.
struct OrientationMeasurement {
  int row = 0;
  Quat orientation = Quat::Identity();
  std::optional<Vec3> sd{};    ///< [rad] about `axes`, where the file gives it
  std::optional<Mat3> axes{};  ///< as of a point
  /// [m rad] cross-covariance of the position error of the tool point measured in the same row (rows: world x y z) and
  /// this orientation error, a small rotation about the world axes (columns); none: independent.
  std::optional<Mat3> covariance_with_point{};
};

/// Distance of the tool point from a fixed anchor (draw wire).
struct DistanceMeasurement {
  int row = 0;
  int anchor = 0;         ///< from 0; files count from 1
  double distance = 0.0;  ///< [m]
};

/// The tool point touches a fixed point of unknown position (ball in socket).
struct SocketContact {
  int row = 0;
  int socket = 0;  ///< index into PoseSet::sockets
};

/// Distance between the tool points of two poses (ball-bar).
struct PairDistance {
  int row = 0;
  int other = 0;          ///< the other row, after `row`
  double distance = 0.0;  ///< [m]
};

/// The tool point touches a fixed plane of unknown pose.
struct PlaneContact {
  int row = 0;
  int plane = 0;  ///< index into PoseSet::planes
};

/// Specific force measured on the tool at rest: +g upward, in the tool frame.
struct TiltMeasurement {
  int row = 0;
  Vec3 specific_force = Vec3::Zero();  ///< [m/s²]
};

/// The part of a train/holdout split to which the file assigns a row.
enum class SplitLabel { none, train, holdout };

struct PoseSet {
  std::vector<std::string> joint_names;  ///< of the rows of `joints`, in the order of the robot's joints
  MatrixXd joints;                       ///< dof x rows, [rad] or [m]
  MatrixXd commanded;                    ///< as `joints`: commanded positions, NaN where unknown; empty: none
  MatrixXd torques;                      ///< dof x rows, [N m] or [N], NaN where not measured; empty: none
  MatrixXd approach;                     ///< dof x rows, −1, 0 or 1: direction of the last movement; empty: none

  std::vector<PointMeasurement> points;
  std::vector<OrientationMeasurement> orientations;
  std::vector<DistanceMeasurement> distances;
  std::vector<SocketContact> contacts;
  std::vector<PairDistance> pairs;
  std::vector<PlaneContact> plane_contacts;
  std::vector<TiltMeasurement> tilts;

  std::vector<std::string> targets;  ///< names that the measurements above refer to
  std::vector<std::string> sockets;
  std::vector<std::string> planes;
  std::vector<std::string> setups;
  std::vector<std::string> sweeps;
  std::vector<std::string> tips;  ///< joints that carry a tool

  std::vector<int> setup;     ///< one per row, index into `setups`, −1: none; empty: none
  std::vector<int> tip;       ///< one per row, index into `tips`, −1: the robot's; empty: none
  std::vector<int> mounting;  ///< one per row, index into Chain::mountings, −1: the chain's base and tool; empty: none
  std::vector<int> sweep;     ///< one per row, index into `sweeps`, −1: none; empty: none
  std::vector<double> payload;      ///< [kg], one per row; empty: none
  std::vector<double> temperature;  ///< [°C], one per row, NaN where not measured; empty: none
  std::vector<std::string> id;      ///< one per row; empty: none
  std::vector<SplitLabel> set;      ///< one per row; empty: none
  std::vector<int> line;            ///< line of each row in its file, from 1

  Eigen::Index rows() const { return joints.cols(); }
};

/// True if any list of measurements is not empty.
bool has_measurements(const PoseSet& set);

/// The listed rows of `from`, in that order, with their measurements. A row may be listed several times; a pair is kept
/// if both of its rows are listed.
PoseSet select(const PoseSet& from, const std::vector<int>& rows);

/// The set with the direction of approach of each joint: the sign of its change since the previous row, 0 in the first
/// row and where it did not move.
PoseSet with_approach(PoseSet set);

/// A covariance as standard deviations along its principal axes: covariance = axes diag(sd²) axesᵀ.
struct PrincipalDeviations {
  Vec3 sd = Vec3::Zero();
  Mat3 axes = Mat3::Identity();
};
/// Negative variances are clamped to zero.
PrincipalDeviations principal_deviations(const Mat3& covariance);
Mat3 covariance_of(const Vec3& sd, const std::optional<Mat3>& axes);

/// Correlation Y of the position and orientation errors of a pose: with each along the principal axes of its own
/// covariance, in units of its own standard deviations, the six have the covariance [I Y; Yᵀ I]. Needs
/// `covariance_with_point`.
Mat3 correlation(const Vec3& point_sd, const std::optional<Mat3>& point_axes, const Vec3& turn_sd,
                 const OrientationMeasurement& orientation);

/// Accuracy of one measurement, one sigma.
struct Instrument {
  double sigma = 0.0;                         ///< [m] per axis
  double sigma_angle = 0.0;                   ///< [rad] per axis
  double ppm = 0.0;                           ///< [1e-6] plus this fraction of the distance from the world origin
  std::optional<double> sigma_distance = {};  ///< [m] of draw wires and ball-bars; none: sigma
  std::optional<double> sigma_contact = {};   ///< [m] of sockets and planes, per axis; none: sigma
  std::optional<double> sigma_tilt = {};      ///< [m/s²] per axis; none: estimated from the residuals
};

/// Standard deviation per axis of a position measured at `position` [m]: sigma + ppm · distance from the world origin.
double position_sd(const Instrument& instrument, const Vec3& position);

}  // namespace kinfer
