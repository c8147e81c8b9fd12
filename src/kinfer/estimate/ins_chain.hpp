// What an INS on each body of a machine feels, body after body from the root, all in the bodies' own frames: angular
// rate, its derivative, specific force and magnetic field. Where the machine stands in the world is not needed: the
// force already contains gravity, whatever its direction.
//
// Through a joint with rotation child_R_parent = B Rz(−q) Aᵀ (axis = third column of A in the parent, of B in the
// child), at the point p in the parent and c in the child, d = p + s·axis for a slide s:
//   f_J = f + ω̇ × d + ω × (ω × d) + 2 ω × ḋ + d̈                                   (parent's frame)
//   ω_c = R ω + q̇ b,   ω̇_c = R ω̇ + q̈ b − q̇ b × R ω,   b = B e_z
//   f_c = R f_J − ω̇_c × c − ω_c × (ω_c × c)                                          (child's frame)
#pragma once

#include <vector>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// What moves in a joint; a ball turns by exp(φ) of a rotation vector, child_R_parent = B exp(−φ) Aᵀ. A universal joint
/// is two turns with a body between them that carries no sensor.
enum class JointMotion { none, turn, slide, ball };
Eigen::Index freedoms(JointMotion motion);

/// A body and the joint that it hangs on. Body 0 is the root and has none.
struct InsBody {
  int parent = -1;
  int sensor = -1;  ///< index of the INS on it; −1: none
  JointMotion motion = JointMotion::none;
  Mat3 parent_R_axis = Mat3::Identity();  ///< A
  Mat3 child_R_axis = Mat3::Identity();   ///< B
  Vec3 point_in_parent = Vec3::Zero();    ///< [m] p
  Vec3 point_in_child = Vec3::Zero();     ///< [m] c
  // What of it is estimated. Turns of A and B are about their own axes x, y, z.
  std::array<bool, 3> free_parent_turn{}, free_child_turn{};
  bool free_point_in_parent = false, free_point_in_child = false;

  Eigen::Index turns() const;     ///< of A and B that are free
  Eigen::Index unknowns() const;  ///< all of it
};

/// Body after body from the root: [A turns, B turns, p, c] of each that are free.
using InsBodies = std::vector<InsBody>;

InsBody turning_body(int parent, int sensor, const Mat3& parent_R_axis, const Mat3& child_R_axis);
InsBody sliding_body(int parent, int sensor, const Mat3& parent_R_axis, const Mat3& child_R_axis);
InsBody ball_body(int parent, int sensor, const Mat3& parent_R_child);
InsBody fixed_body(int parent, int sensor, const Mat3& parent_R_child);

/// Changes the unknowns by `step` (unknowns() long): turns are multiplied from the right, points are added.
InsBody changed(const InsBody& body, ConstVectorRef step);

/// Motion of one body at one time, in its own frame.
struct InsState {
  Vec3 rate = Vec3::Zero();         ///< [rad/s]
  Vec3 rate_change = Vec3::Zero();  ///< [rad/s²]
  Vec3 force = Vec3::Zero();        ///< [m/s²] specific force at the sensor's origin
  Vec3 field = Vec3::Zero();        ///< magnetic field
};
using StateColumns = Eigen::Matrix<double, 12, Eigen::Dynamic>;  ///< derivatives, rows as the members of InsState

/// Joint reading with its derivatives by time: [rad] or [m], per second, per second². All of it for a ball, else x.
using JointReading = std::array<Vec3, 3>;

InsState carried(const InsBody& body, const JointReading& q, const InsState& parent);

/// The same with derivatives: of the child's state by the parent's (12 x 12), and by the reading (of each freedom the
/// value and its two derivatives by time) and the body's unknowns (12 x (3 freedoms + unknowns)).
struct CarriedDerivative {
  InsState state;
  Eigen::Matrix<double, 12, 12> by_parent;
  StateColumns by_own;
};
void carry(const InsBody& body, const JointReading& q, const InsState& parent, CarriedDerivative& out);

}  // namespace kinfer
