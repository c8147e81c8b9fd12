// SPDX-License-Identifier: Apache-2.0
// Where the bodies of a machine are at one time, in the root's frame, and how a point of a body moves with the unknowns
// of the continuous-time fit.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer {

/// Pose of a body and its joint at one time, in the root's frame.
struct BodyKinematics {
  Mat3 parent = Mat3::Identity();     ///< root_R_parent
  Mat3 before = Mat3::Identity();     ///< root_R_parent A: joint axes before the joint rotation
  Mat3 after = Mat3::Identity();      ///< the same after the joint rotation
  Mat3 rotation_axes = Mat3::Zero();  ///< root: rotation axis of each degree of freedom, a column each
  Mat3 rotation = Mat3::Identity();   ///< root_R_body
  Vec3 pivot = Vec3::Zero();          ///< the joint point p
  Vec3 joint = Vec3::Zero();          ///< p + prismatic displacement
  Vec3 origin = Vec3::Zero();         ///< of the body

  Pose pose() const { return {rotation, origin}; }  ///< root_T_body
};

/// Forward kinematics of the machine at one time.
struct MachineSnapshot {
  Eigen::Index interval = 0;
  SplineBasis basis;
  std::vector<BodyKinematics> body;
};
MachineSnapshot machine_snapshot(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, double time);

using Rows3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// A point fixed to a body: its position, and the derivatives of position and rotation of the body (as a rotation
/// vector in the root's frame) with respect to the spline coefficients of the interval and the global parameters.
struct PointJacobian {
  Vec3 position = Vec3::Zero();
  Rows3 by_position, by_rotation;
};

/// First column of the global parameters.
inline Eigen::Index first_global(const InsLayout& layout) {
  return spline_order * layout.spline_dimensions;
}

/// Of the point `local` in the body's frame.
PointJacobian jacobian_at(const InsLayout& layout, const InsUnknowns& x, const MachineSnapshot& s, std::size_t body,
                          const Vec3& local);

/// Of the point p of the body's joint, as a point of its parent; the rotation is that of the joint's frame A.
PointJacobian jacobian_at_joint(const InsLayout& layout, const InsUnknowns& x, const MachineSnapshot& s,
                                std::size_t body);

}  // namespace kinfer
