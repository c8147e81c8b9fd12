// SPDX-License-Identifier: Apache-2.0
// Forward kinematics of the tool, and its analytic derivatives by joint positions and by parameters.
//
// Each parameter is the coordinate of an elementary motion (a rotation about or a translation along one axis), so its
// effect on the tool is a screw: d position = axis × (tool − origin) or axis; d rotation = axis or 0. The geometric
// Jacobian is the same for the joint variables.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

/// 6 x n: rows 0-2 change of position [m], rows 3-5 change of orientation as a rotation vector in the world [rad].
using Twists = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// 3 x n: change of the position of a point that is fixed in the tool, `arm` from the tool point (world axes) [m].
Eigen::Matrix<double, 3, Eigen::Dynamic> point_columns(const Twists& twists, const Vec3& arm);

/// Loads on the chain at one pose.
struct Load {
  double payload = 0.0;                ///< [kg] point mass at the tool point
  double temperature_rise = 0.0;       ///< [K] above the reference temperature of the chain
  std::span<const double> torques{};   ///< [N m] measured, one per active joint; empty: none
  std::span<const double> gravity{};   ///< [N m] gravity torque about each joint axis; empty: that of the chain
  std::span<const double> approach{};  ///< −1, 0 or 1, direction in which each q was approached; empty: none
};

/// Entry of a list of a Load; 0 where it was not measured.
double value_or_zero(std::span<const double> values, int q_index);

/// world_T_tool at the joint positions q (dof, [rad] or [m]).
Pose forward(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// world_T_frame of every joint's frame (after its motion), in the order of the joints.
std::vector<Pose> joint_frames(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// A joint in the world: its frame after its motion, and the axis that it moves about or along.
struct JointPlacement {
  Pose frame;
  Vec3 axis = Vec3::Zero();   ///< unit; zero for a fixed joint
  Vec3 point = Vec3::Zero();  ///< a point of the axis
};

/// Every joint at the joint positions q, in the order of the joints.
std::vector<JointPlacement> joint_placements(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// Geometric Jacobian of the tool by the joint positions, 6 x dof. Compliance: the torques are held constant.
Twists jacobian(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// Gravity torque about each joint axis [N m], of the undeflected chain, in the order of the joints (0: not revolute).
VectorXd gravity_torques(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// The same for joints whose frames are known.
VectorXd gravity_torques(const Chain& chain, const std::vector<JointPlacement>& placed, const Load& load = {});
void gravity_torques(const Chain& chain, const std::vector<JointPlacement>& placed, const Load& load,
                     VectorXd& torques);

/// Index into q of each joint; -1 where it is not active.
std::vector<int> active_joint_indices(const Chain& chain);

/// Displacement of each joint variable by q: gain · q + couplings, linear in q, in the order of the joints [rad] or
/// [m].
VectorXd joint_displacements(const Chain& chain, ConstVectorRef q);

/// Further displacement of each joint variable, by harmonics, measured torques and backlash [rad] or [m].
VectorXd deviations(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// The joint on the frame of its parent, displaced from its offset by so much [rad] or [m].
JointPlacement place_joint(const Pose& parent, const Joint& joint, double displacement);

/// Evaluates one chain at many poses: link constants and their sines are computed once.
class PoseEvaluator {
 public:
  /// Columns of the derivative follow the free parameters of `set`. Compliance: torques are held constant in the
  /// derivative by other parameters (their change is of second order in the errors).
  PoseEvaluator(const Chain& chain, const ParameterSet& set);
  ~PoseEvaluator();
  PoseEvaluator(PoseEvaluator&&) noexcept;

  Pose pose(ConstVectorRef q, const Load& load = {}) const;

  /// Pose, and its derivative by the free parameters in `twists` (resized to 6 x free_count; a buffer for the hot
  /// loop).
  Pose pose_and_derivative(ConstVectorRef q, const Load& load, Twists& twists) const;

 private:
  struct Program;
  std::unique_ptr<Program> program_;
};

}  // namespace kinfer
