// Where the tool is, and how that changes with every reading and every parameter, analytically.
//
// Each parameter is the coordinate of an elementary motion (a turn about or a shift along one axis), so its effect on
// the tool is a screw: d position = axis × (tool − origin) or axis; d rotation = axis or 0. The geometric Jacobian is
// the same for the joint variables.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

/// 6 x n: rows 0-2 change of position [m], rows 3-5 change of orientation as a rotation vector in the world [rad].
using Twists = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// What acts on the chain at one pose besides its readings.
struct Load {
  double payload = 0.0;                ///< [kg] point mass at the tool point
  double warming = 0.0;                ///< [K] above the chain's reference temperature
  std::span<const double> torques{};   ///< [N m] measured, one a reading; empty: none
  std::span<const double> gravity{};   ///< [N m] its torque about each joint's axis; empty: of the chain as it is
  std::span<const double> approach{};  ///< −1, 0 or 1, the sense in which each reading was approached; empty: none
};

/// A value of a load's list; 0 where it was not measured.
double value_or_zero(std::span<const double> values, int reading);

/// world_T_tool for the readings q (dof, [rad] or [m]).
Pose forward(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// world_T_frame of every joint's frame (after its motion), in the order of the joints.
std::vector<Pose> joint_frames(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// A joint in the world: its frame after its motion, and the line that it moves about or along.
struct PlacedJoint {
  Pose frame;
  Vec3 axis = Vec3::Zero();   ///< unit; zero for a fixed joint
  Vec3 point = Vec3::Zero();  ///< a point of the axis
};

/// Every joint at the readings q, in the order of the joints.
std::vector<PlacedJoint> placed_joints(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// Geometric Jacobian of the tool by the readings, 6 x dof. Compliance: the torques are held constant.
Twists jacobian(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// Torque of gravity about each joint's axis [N m], of the undeflected chain, in the order of the joints (0: not
/// revolute).
VectorXd gravity_torques(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// Torque of gravity about each joint's axis for joints placed already.
VectorXd gravity_torques(const Chain& chain, const std::vector<PlacedJoint>& placed, const Load& load = {});
void gravity_torques(const Chain& chain, const std::vector<PlacedJoint>& placed, const Load& load, VectorXd& torques);

/// Index into q of each joint's reading; -1 where it has none.
std::vector<int> reading_indices(const Chain& chain);

/// What the readings add to each joint's variable, gain · reading + couplings, in the order of the joints [rad] or [m].
/// Linear in the readings.
VectorXd moved_by_readings(const Chain& chain, ConstVectorRef q);

/// What harmonics, measured torques and the approach add to each joint's variable besides [rad] or [m].
VectorXd deviations(const Chain& chain, ConstVectorRef q, const Load& load = {});

/// The joint on its parent's frame when it has moved so far from its offset [rad] or [m].
PlacedJoint place(const Pose& parent, const Joint& joint, double moved);

/// Evaluates one chain at many poses: link constants and their sines are folded once.
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
