// Joint readings of a robot and what an outside instrument measured at each pose.
//
// One row a pose; each kind of measurement is a list of its own that names its row, so a new instrument is a new list.
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
  /// [m rad] covariance of the error of the tool point measured in the same row (rows: x y z of the world) with this
  /// one's error, a small turn of the world's axes (columns); none: independent.
  std::optional<Mat3> with_point{};
};

/// Distance of the tool point from a fixed anchor (draw wire).
struct DistanceMeasurement {
  int row = 0;
  int anchor = 0;         ///< from 0; files count from 1
  double distance = 0.0;  ///< [m]
};

/// The tool point touches a fixed point whose place is not known.
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

/// The tool point touches a plane that is not known.
struct PlaneContact {
  int row = 0;
  int plane = 0;  ///< index into PoseSet::planes
};

/// Specific force felt by the tool at rest: +g upward, in the tool's frame.
struct TiltMeasurement {
  int row = 0;
  Vec3 specific_force = Vec3::Zero();  ///< [m/s²]
};

/// To which side of a split a row was given by the file.
enum class SetLabel { none, train, holdout };

struct PoseSet {
  std::vector<std::string> joint_names;  ///< of the rows of `joints`, in the order of the robot's readings
  MatrixXd joints;                       ///< dof x rows, [rad] or [m]
  MatrixXd commanded;                    ///< as `joints`, what the controller was told, NaN where unknown; empty: none
  MatrixXd torques;                      ///< dof x rows, [N m] or [N], NaN where not measured; empty: none
  MatrixXd approach;                     ///< dof x rows, −1, 0 or 1: sense of the last movement; empty: none

  std::vector<PointMeasurement> points;
  std::vector<OrientationMeasurement> orientations;
  std::vector<DistanceMeasurement> distances;
  std::vector<SocketContact> contacts;
  std::vector<PairDistance> pairs;
  std::vector<PlaneContact> plane_contacts;
  std::vector<TiltMeasurement> tilts;

  std::vector<std::string> targets;  ///< names that the lists above index
  std::vector<std::string> sockets;
  std::vector<std::string> planes;
  std::vector<std::string> setups;
  std::vector<std::string> sweeps;
  std::vector<std::string> tips;  ///< joints that carry a tool

  std::vector<int> setup;     ///< one a row, index into `setups`, −1: none; empty: none
  std::vector<int> tip;       ///< one a row, index into `tips`, −1: the robot's; empty: none
  std::vector<int> mounting;  ///< one a row, index into Chain::mountings, −1: base and tool as they are; empty: none
  std::vector<int> sweep;     ///< one a row, index into `sweeps`, −1: none; empty: none
  std::vector<double> payload;      ///< [kg], one a row; empty: none
  std::vector<double> temperature;  ///< [°C], one a row, NaN where not measured; empty: none
  std::vector<std::string> id;      ///< one a row; empty: none
  std::vector<SetLabel> set;        ///< one a row; empty: none
  std::vector<int> line;            ///< line of each row in its file, from 1

  Eigen::Index rows() const { return joints.cols(); }
};

/// True where some list of measurements is not empty.
bool has_measurements(const PoseSet& set);

/// The rows of `from` that are listed, in that order, with their measurements. A row may be listed several times; a
/// pair stays where both of its rows are listed.
PoseSet select(const PoseSet& from, const std::vector<int>& rows);

/// The set with the sense in which each reading was approached: the sign of its change since the row before, 0 in the
/// first row and where it did not move.
PoseSet with_approach(PoseSet set);

/// A covariance as standard deviations along its principal axes: covariance = axes diag(sd²) axesᵀ.
struct PrincipalDeviations {
  Vec3 sd = Vec3::Zero();
  Mat3 axes = Mat3::Identity();
};
/// A variance below zero counts as zero.
PrincipalDeviations principal_deviations(const Mat3& covariance);
Mat3 covariance_of(const Vec3& sd, const std::optional<Mat3>& axes);

/// How the errors of a pose's point and orientation go together: with each along the axes of its own covariance, in
/// units of its own deviations, the six have the covariance [I Y; Yᵀ I]. Needs `with_point`.
Mat3 correlation(const Vec3& point_sd, const std::optional<Mat3>& point_axes, const Vec3& turn_sd,
                 const OrientationMeasurement& orientation);

/// What one measurement is worth, one sigma.
struct Instrument {
  double sigma = 0.0;                         ///< [m] per axis
  double sigma_angle = 0.0;                   ///< [rad] per axis
  double ppm = 0.0;                           ///< plus this much of the distance from the world's origin, 1e-6
  std::optional<double> sigma_distance = {};  ///< [m] of draw wires and ball-bars; none: sigma
  std::optional<double> sigma_contact = {};   ///< [m] of sockets and planes, per axis; none: sigma
  std::optional<double> sigma_tilt = {};      ///< [m/s²] per axis; none: judged from the residuals
};

/// Standard deviation per axis of a position measured at `position` [m]: sigma + ppm · distance from the world's
/// origin.
double position_sd(const Instrument& instrument, const Vec3& position);

}  // namespace kinfer
