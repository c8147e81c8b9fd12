// SPDX-License-Identifier: Apache-2.0
// Bodies of the continuous-time fit with random orientations of the axis, drawn in the parent first.
#pragma once

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/evidence/facts/estimated_joint_type.hpp"
#include "kinfer/geometry/pose.hpp"
#include "support/random.hpp"

namespace kinfer::test {

inline Mat3 random_rotation(Rng& rng) {
  return exp_so3(random_vector(rng));
}

inline InsBody random_revolute_body(int parent, int sensor, Rng& rng) {
  const Mat3 parent_R_axis = random_rotation(rng), child_R_axis = random_rotation(rng);
  return revolute_body(parent, sensor, parent_R_axis, child_R_axis);
}

inline InsBody random_prismatic_body(int parent, int sensor, Rng& rng) {
  const Mat3 parent_R_axis = random_rotation(rng), child_R_axis = random_rotation(rng);
  return prismatic_body(parent, sensor, parent_R_axis, child_R_axis);
}

/// A joint of this type, one body or two in series.
inline std::vector<InsBody> bodies_of(EstimatedJointType type, Rng& rng) {
  const auto turn = [&] { return exp_so3(random_vector(rng)); };
  std::vector<InsBody> bodies;
  if (type == EstimatedJointType::prismatic) bodies = {random_prismatic_body(0, 1, rng)};
  if (type == EstimatedJointType::revolute) bodies = {random_revolute_body(0, 1, rng)};
  if (type == EstimatedJointType::spherical) bodies = {spherical_body(0, 1, turn())};
  if (type == EstimatedJointType::universal) {
    bodies = {revolute_body(0, -1, turn(), Mat3::Identity()), revolute_body(1, 1, rot_y(1.2), turn())};
    bodies[0].free_child_rotation = {};
    bodies[1].free_parent_rotation = {false, true, false};
    bodies[0].free_point_in_child = bodies[1].free_point_in_parent = false;
  }
  bodies.front().point_in_parent = random_vector(rng);
  if (type != EstimatedJointType::prismatic) bodies.back().point_in_child = random_vector(rng);
  return bodies;
}

/// parent_T_child of the continuous-time fit.
inline Pose pose_of(const std::vector<InsBody>& bodies, const VectorXd& reading) {
  Pose parent_T_here;
  Eigen::Index k = 0;
  for (const InsBody& body : bodies) {
    Mat3 turn = Mat3::Identity();
    Vec3 slid = Vec3::Zero();
    if (body.motion == JointMotion::revolute) turn = rot_z(reading[k]);
    if (body.motion == JointMotion::prismatic) slid = reading[k] * body.parent_R_axis.col(2);
    if (body.motion == JointMotion::spherical) turn = exp_so3(reading.segment<3>(k));
    k += degrees_of_freedom(body.motion);
    const Mat3 rotation = body.parent_R_axis * turn * body.child_R_axis.transpose();
    parent_T_here = parent_T_here * Pose{rotation, body.point_in_parent + slid - rotation * body.point_in_child};
  }
  return parent_T_here;
}

}  // namespace kinfer::test
