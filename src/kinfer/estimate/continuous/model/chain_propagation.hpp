// SPDX-License-Identifier: Apache-2.0
// Forward propagation of what an INS on each body measures, from the root outward, in body frames: angular velocity,
// angular acceleration, specific force and magnetic field. The machine's pose in the world is not needed: the specific
// force already contains gravity, whatever its direction.
//
// Through a joint with rotation child_R_parent = B Rz(−q) Aᵀ (axis = third column of A in the parent, of B in the
// child), at the point p in the parent and c in the child, d = p + s·axis for a prismatic
// displacement s:
//   f_J = f + ω̇ × d + ω × (ω × d) + 2 ω × ḋ + d̈                                   (parent's frame)
//   ω_c = R ω + q̇ b,   ω̇_c = R ω̇ + q̈ b − q̇ b × R ω,   b = B e_z
//   f_c = R f_J − ω̇_c × c − ω_c × (ω_c × c)                                          (child's frame)
#pragma once

#include <vector>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// Motion of a joint: fixed, revolute, prismatic or spherical. A spherical joint rotates by exp(φ) of a rotation
/// vector, child_R_parent = B exp(−φ) Aᵀ. A universal joint is two revolute joints with a body without a sensor between
/// them.
enum class JointMotion { fixed, revolute, prismatic, spherical };
Eigen::Index degrees_of_freedom(JointMotion motion);

/// A body and the joint that connects it to its parent. Body 0 is the root and has no joint.
struct InsBody {
  int parent = -1;
  int sensor = -1;  ///< index of the INS on it; −1: none
  JointMotion motion = JointMotion::fixed;
  Mat3 parent_R_axis = Mat3::Identity();  ///< A
  Mat3 child_R_axis = Mat3::Identity();   ///< B
  Vec3 point_in_parent = Vec3::Zero();    ///< [m] p
  Vec3 point_in_child = Vec3::Zero();     ///< [m] c
  // Which of these are estimated. Rotation increments of A and B are about their own axes x, y, z.
  std::array<bool, 3> free_parent_rotation{}, free_child_rotation{};
  bool free_point_in_parent = false, free_point_in_child = false;

  Eigen::Index turns() const;     ///< number of free rotation increments of A and B
  Eigen::Index unknowns() const;  ///< number of all free unknowns
};

/// In topological order from the root. Unknowns of each body: [rotation of A, rotation of B, p, c], the free ones.
using InsBodies = std::vector<InsBody>;

InsBody revolute_body(int parent, int sensor, const Mat3& parent_R_axis, const Mat3& child_R_axis);
InsBody prismatic_body(int parent, int sensor, const Mat3& parent_R_axis, const Mat3& child_R_axis);
InsBody spherical_body(int parent, int sensor, const Mat3& parent_R_child);
InsBody fixed_body(int parent, int sensor, const Mat3& parent_R_child);

/// Applies `step` (unknowns() long) to the unknowns: rotations are multiplied from the right, points are added.
InsBody retract(const InsBody& body, ConstVectorRef step);

/// Motion of one body at one time, in its own frame.
struct InsState {
  Vec3 angular_velocity = Vec3::Zero();      ///< [rad/s]
  Vec3 angular_acceleration = Vec3::Zero();  ///< [rad/s²]
  Vec3 force = Vec3::Zero();                 ///< [m/s²] specific force at the sensor's origin
};
inline constexpr Eigen::Index state_size =
    9;  ///< numbers of a state; rows of its Jacobians, as the members of InsState
inline constexpr Eigen::Index rate_row = 0, force_row = 6;  ///< first rows of what an INS measures
using StateJacobian = Eigen::Matrix<double, state_size, Eigen::Dynamic>;

/// Joint position, velocity and acceleration: [rad] or [m], per second, per second². Spherical joints use all three
/// components, others only x.
using JointKinematicState = std::array<Vec3, 3>;

InsState propagated(const InsBody& body, const JointKinematicState& q, const InsState& parent);

/// The same with Jacobians of the child's state: with respect to the parent's state (9 x 9), and to the joint state
/// (of each degree of freedom position, velocity and acceleration) and the body's unknowns (9 x (3 dof + unknowns)).
struct PropagatedDerivative {
  InsState state;
  Eigen::Matrix<double, state_size, state_size> by_parent;
  StateJacobian by_own;
};
void propagate(const InsBody& body, const JointKinematicState& q, const InsState& parent, PropagatedDerivative& out);

}  // namespace kinfer
