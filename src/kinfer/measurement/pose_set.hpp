// SPDX-License-Identifier: Apache-2.0
// Joint positions of a robot and the external measurements of each pose, one row per pose.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/geometry/pose.hpp"
#include "kinfer/linalg/types.hpp"
#include "kinfer/measurement/measurements.hpp"

namespace kinfer {

/// What the robot's controller logged.
struct RecordedJoints {
  std::vector<std::string> joint_names;  ///< of the rows of `joints`, in the order of the robot's joints
  MatrixXd joints;                       ///< dof x rows, [rad] or [m]
  MatrixXd commanded;                    ///< as `joints`: commanded positions, NaN where unknown; empty: none
};

/// Inputs of the non-geometric model terms, besides the joint positions. An empty member was not recorded.
struct RowConditions {
  MatrixXd torques;                 ///< dof x rows, [N m] or [N], NaN where not measured
  MatrixXd approach;                ///< dof x rows, −1, 0 or 1: direction of the last movement
  std::vector<double> payload;      ///< [kg], one per row
  std::vector<double> temperature;  ///< [°C], one per row, NaN where not measured
};

/// Groups that rows belong to.
struct RowGroups {
  std::vector<std::string> setups, sweeps;
  std::vector<std::string> tips;  ///< joints that carry a tool
  std::vector<int> setup;         ///< one per row, index into `setups`, −1: none; empty: none
  std::vector<int> tip;           ///< one per row, index into `tips`, −1: the robot's; empty: none
  std::vector<int> sweep;         ///< one per row, index into `sweeps`, −1: none; empty: none
  std::vector<int> mounting;  ///< one per row, index into Chain::mountings, −1: the chain's base and tool; empty: none
  std::vector<int> pose;      ///< one per row: rows of one commanded pose have the same number; empty: not known
};

/// The part of a train/holdout split to which the file assigns a row.
enum class SplitLabel { none, train, holdout };

/// Where each row came from.
struct RowOrigin {
  std::vector<std::string> id;  ///< one per row; empty: none
  std::vector<SplitLabel> set;  ///< one per row; empty: none
  std::vector<int> line;        ///< line of each row in its file, from 1
  std::vector<double> time;     ///< [s] one per row; empty: none
};

struct PoseSet : RecordedJoints, RowConditions, PoseMeasurements, FixtureNames, RowGroups, RowOrigin {
  Eigen::Index rows() const { return joints.cols(); }
};

/// True if any list of measurements is not empty.
bool has_measurements(const PoseMeasurements& measured);

/// Positions of all measured points [m], in their order.
std::vector<Vec3> point_positions(const PoseMeasurements& measured);

/// The listed rows of `from`, in that order, with their measurements. A row may be listed several times; a pair is kept
/// if both of its rows are listed.
PoseSet select(const PoseSet& from, const std::vector<int>& rows);

/// The set with the direction of approach of each joint: the sense of its last movement up to each row, 0 before the
/// first one. A joint that rests stays on its flank. What returns by less than 1e-4 of the joint's range is scatter of
/// its readings and no movement; so is all between rows of one commanded pose, where these are known.
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

}  // namespace kinfer
