// SPDX-License-Identifier: Apache-2.0
// Kinematic model of a machine: a tree of joints from a base to a tool, each joint a product of elementary motions.
//
// Standard DH (paper 1, eq. 1): RotZ(theta) TransZ(d) TransX(a) RotX(alpha) RotY(beta)
//
// Modified DH (paper 2, eq. 3): RotX(alpha) TransX(a) RotY(beta) RotZ(theta) TransZ(d), with a_{i-1} and alpha_{i-1}
//
// URDF: Trans(xyz) R(rpy), then the joint motion about or along `axis`
//
// The variable of a DH row is in theta or d. beta is Hayati's angle for nearly parallel axes (Hayati, Mirmirani 1985).
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "kinfer/base/constants.hpp"
#include "kinfer/kinematics/displacement_field.hpp"
#include "kinfer/kinematics/fixtures.hpp"
#include "kinfer/kinematics/frame.hpp"
#include "kinfer/kinematics/joint_type.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// The five numbers of a DH row.
struct DhNumbers {
  double a = 0.0;      ///< [m]
  double alpha = 0.0;  ///< [rad]
  double d = 0.0;      ///< [m]
  double theta = 0.0;  ///< [rad]
  double beta = 0.0;   ///< [rad]
};
struct DhLink : DhNumbers {};
struct MdhLink : DhNumbers {};
struct UrdfLink {
  Frame origin;               ///< of the joint's frame in its parent's
  Vec3 axis = Vec3::UnitZ();  ///< unit, in the joint's frame
};
using Link = std::variant<DhLink, MdhLink, UrdfLink>;

/// Adds factor · (position of that joint) to the variable of this joint, as belts and parallel linkages do.
struct Coupling {
  int joint = 0;  ///< index into Chain::joints of an active joint
  double factor = 0.0;
};

/// variable += sine · sin(order · q) + cosine · cos(order · q): transmission error that is periodic in the rotation of
/// an eccentric gear (orders 1 and 2) or of the motor (gear ratio times 1 and 2). Revolute joints only.
struct Harmonic {
  double order = 1.0;               ///< periods per revolution of the joint
  double sine = 0.0, cosine = 0.0;  ///< [rad]
};

struct Joint {
  std::string name{};
  int parent = -1;  ///< index of the joint before it; -1: the base
  JointType type = JointType::revolute;
  Link link = MdhLink{};
  bool is_active = true;  ///< false: moves by its couplings only (URDF mimic), or not at all (fixed)
  double gain = 1.0;      ///< variable = offset + gain · q + couplings
  std::vector<Coupling> couplings{};
  double compliance = 0.0;         ///< [rad/(N m)], revolute: variable += compliance · gravity torque about the axis
  double torque_compliance = 0.0;  ///< [rad/(N m)], revolute: variable += torque_compliance · measured joint torque
  double backlash = 0.0;           ///< [rad] or [m]: variable += backlash · direction of approach (−1, 0, 1)
  std::vector<Harmonic> harmonics{};
  double lower = -std::numeric_limits<double>::infinity();  ///< limits of the joint position q, [rad] or [m]
  double upper = std::numeric_limits<double>::infinity();
};

/// A point mass that loads the joints before it.
struct PointMass {
  int joint = 0;            ///< index of the joint whose frame carries it
  Vec3 com = Vec3::Zero();  ///< [m] in that frame
  double mass = 0.0;        ///< [kg]
};

/// A further set-up in which the same robot was measured: a base and tool of its own, or another branch of a tree.
struct RobotMounting {
  std::string name{};
  std::optional<Frame> base{};  ///< none: the chain's
  Frame tool{};
  int tip = -1;  ///< index of the joint that carries this tool; −1: the chain's
};

/// A revolute joint that closes a kinematic loop, as of a four-bar linkage: the line fixed in the frame of one joint
/// and the line fixed in the frame of another coincide, points and directions. Joint positions are independent in a
/// Chain: that they close the loop is up to whoever sets them.
struct LoopClosure {
  std::string name{};
  int first = -1, second = -1;  ///< indices of the joints whose frames carry the lines; −1: the base
  Vec3 point_in_first = Vec3::Zero(), point_in_second = Vec3::Zero();  ///< [m]
  Vec3 axis_in_first = Vec3::UnitZ(), axis_in_second = Vec3::UnitZ();  ///< unit
};

struct Chain {
  std::string name{};
  std::string setup{};        ///< name of the set-up that base and tool belong to; empty: there is only one
  Frame base;                 ///< world_T_base
  std::vector<Joint> joints;  ///< parents before children
  std::vector<LoopClosure> closures{};
  Frame tool;    ///< flange_T_tool, on the frame of joint `tip`
  int tip = -1;  ///< index of the joint that carries the tool; -1: the last joint
  std::vector<Target> targets;
  std::vector<PointMass> masses;
  Vec3 gravity = Vec3(0, 0, -standard_gravity);  ///< [m/s²] in the world frame
  double expansion = 0.0;              ///< [1/K]: all lengths of the joints grow by expansion · temperature rise
  double reference_temperature = 0.0;  ///< [°C] at which the lengths are as written
  DisplacementField field{};           ///< of the tool, beyond all that joints, links and loads explain
  Fixtures fixtures{};
  std::vector<RobotMounting> mountings{};  ///< in addition to base and tool above

  int tip_joint() const { return tip >= 0 ? tip : static_cast<int>(joints.size()) - 1; }
};

/// Indices of the active joints (neither fixed nor driven by couplings alone), in order: entry k is moved by q[k].
std::vector<int> active_joints(const Chain& chain);

/// Number of active joints, the length of a joint vector q.
int dof(const Chain& chain);

/// The chain in mounting `index` of its list: base, tool and tip are those of the mounting. −1: unchanged.
Chain with_mounting(const Chain& chain, int index);

/// Joint indices from the base to joint `tip`.
std::vector<int> path_to(const Chain& chain, int tip);

/// Names of the active joints, in the order of q.
std::vector<std::string> active_joint_names(const Chain& chain);

/// Limits of the positions of the active joints, in the order of q [rad] or [m]; infinite where there is none.
struct JointLimits {
  VectorXd lower, upper;
  VectorXd clamped(const VectorXd& q) const;
};
JointLimits joint_limits(const Chain& chain);

/// The joint's position depends on more than its own q and its couplings: on loads (compliance), the direction of
/// approach (backlash) or the angle (harmonics).
bool has_non_geometric_terms(const Joint& joint);
/// Any joint has, lengths grow with temperature, or the tool is displaced by a field.
bool has_non_geometric_terms(const Chain& chain);

/// Aborts (programming error) unless parents precede children and all indices are in range.
void expect_well_formed(const Chain& chain);

/// The chain with the small rotation of each frame multiplied into its rotation matrix and zeroed: same poses.
Chain with_small_rotations_folded(Chain chain);

}  // namespace kinfer
