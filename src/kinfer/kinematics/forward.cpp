// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/forward.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/elementary_motions.hpp"

namespace kinfer {
namespace {

/// Applies the factors of one joint to the frame of its parent, and stores the axis it moves about or along.
struct PlacementVisitor {
  JointPlacement placed;
  double displacement = 0.0;

  void operator()(const Mat3& rotation) { placed.frame.rotation *= rotation; }
  void operator()(const elementary::Factor& factor) {
    if (factor.moves) {
      placed.axis = placed.frame.rotation.col(factor.axis);
      placed.point = placed.frame.position;
    }
    elementary::apply(placed.frame, factor.motion, factor.axis,
                      factor.moves ? factor.value + displacement : factor.value);
  }
};

bool has_gravity_deflection(const Chain& chain, const Load& load) {
  const auto bends = [](const Joint& j) { return j.compliance != 0.0; };
  return (load.payload != 0.0 || !chain.masses.empty() || !load.gravity.empty()) &&
         std::any_of(chain.joints.begin(), chain.joints.end(), bends);
}

/// Displacement of each joint from its offset, deflection by gravity included.
VectorXd displacements(const Chain& chain, ConstVectorRef q, const Load& load) {
  VectorXd displacement = joint_displacements(chain, q) + deviations(chain, q, load);
  if (!has_gravity_deflection(chain, load)) return displacement;
  const VectorXd torques = load.gravity.empty() ? gravity_torques(chain, q, load)
                                                : VectorXd::Map(load.gravity.data(), displacement.size()).eval();
  for (Eigen::Index j = 0; j < displacement.size(); ++j) displacement[j] += chain.joints[j].compliance * torques[j];
  return displacement;
}

std::vector<JointPlacement> compute_placements(const Chain& chain, ConstVectorRef displacement) {
  const Pose base = chain.base.pose();
  std::vector<JointPlacement> placed(chain.joints.size());
  for (std::size_t j = 0; j < placed.size(); ++j) {
    const Joint& joint = chain.joints[j];
    placed[j] = place_joint(joint.parent >= 0 ? placed[joint.parent].frame : base, joint,
                            displacement[static_cast<Eigen::Index>(j)]);
  }
  return placed;
}

/// A point of the robot after thermal expansion of all lengths.
Vec3 thermally_expanded(const Chain& chain, const Load& load, const Vec3& point) {
  return point + chain.expansion * load.temperature_rise * (point - chain.base.xyz);
}

Pose tool_pose(const Chain& chain, const std::vector<JointPlacement>& placed) {
  const int tip = chain.tip_joint();
  return (tip >= 0 ? placed[tip].frame : chain.base.pose()) * chain.tool.pose();
}

/// Twist of the tool per unit motion of the joint. `stretch`: thermal, of all lengths; positions are stretched already.
Eigen::Matrix<double, 6, 1> screw(JointType type, const JointPlacement& joint, const Vec3& tool, double stretch) {
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();
  if (rotates(type)) twist << joint.axis.cross(tool - joint.point), joint.axis;
  if (translates(type)) twist.head<3>() = stretch * joint.axis;
  return twist;
}

}  // namespace

Eigen::Matrix<double, 3, Eigen::Dynamic> point_columns(const Twists& twists, const Vec3& arm) {
  return twists.topRows<3>() - skew(arm) * twists.bottomRows<3>();
}

double value_or_zero(std::span<const double> values, int q_index) {
  return values.empty() || std::isnan(values[q_index]) ? 0.0 : values[q_index];
}

std::vector<int> active_joint_indices(const Chain& chain) {
  std::vector<int> index(chain.joints.size(), -1);
  const std::vector<int> joints = active_joints(chain);
  for (int k = 0; k < static_cast<int>(joints.size()); ++k) index[joints[k]] = k;
  return index;
}

VectorXd joint_displacements(const Chain& chain, ConstVectorRef q) {
  KINFER_EXPECT(q.size() == dof(chain), "{} joint positions for {} joints that have one", q.size(), dof(chain));
  const std::vector<int> index = active_joint_indices(chain);
  VectorXd displacement(chain.joints.size());
  for (Eigen::Index j = 0; j < displacement.size(); ++j) {
    const Joint& joint = chain.joints[j];
    displacement[j] = index[j] >= 0 ? joint.gain * q[index[j]] : 0.0;
    for (const Coupling& c : joint.couplings) displacement[j] += c.factor * q[index[c.joint]];
  }
  return displacement;
}

VectorXd deviations(const Chain& chain, ConstVectorRef q, const Load& load) {
  const std::vector<int> index = active_joint_indices(chain);
  VectorXd added = VectorXd::Zero(static_cast<Eigen::Index>(chain.joints.size()));
  for (Eigen::Index j = 0; j < added.size(); ++j) {
    const Joint& joint = chain.joints[j];
    const int k = index[j];
    if (k < 0) continue;
    for (const Harmonic& h : joint.harmonics)
      added[j] += h.sine * std::sin(h.order * q[k]) + h.cosine * std::cos(h.order * q[k]);
    added[j] += joint.torque_compliance * value_or_zero(load.torques, k);
    added[j] += joint.backlash * value_or_zero(load.approach, k);
  }
  return added;
}

JointPlacement place_joint(const Pose& parent, const Joint& joint, double displacement) {
  PlacementVisitor placer{{.frame = parent}, displacement};
  elementary::for_each_factor(joint, placer);
  return placer.placed;
}

std::vector<JointPlacement> joint_placements(const Chain& chain, ConstVectorRef q, const Load& load) {
  std::vector<JointPlacement> placed = compute_placements(chain, displacements(chain, q, load));
  for (JointPlacement& joint : placed) {
    joint.point = thermally_expanded(chain, load, joint.point);
    joint.frame.position = thermally_expanded(chain, load, joint.frame.position);
  }
  return placed;
}

Pose forward(const Chain& chain, ConstVectorRef q, const Load& load) {
  const VectorXd displacement = displacements(chain, q, load);
  Pose pose = chain.base.pose();
  for (const int j : path_to(chain, chain.tip_joint()))
    pose = place_joint(pose, chain.joints[j], displacement[j]).frame;
  pose.position = thermally_expanded(chain, load, pose.position);
  pose = pose * chain.tool.pose();
  if (!chain.field.empty()) pose.position += chain.base.pose().rotation * displacement_at(chain.field, q);
  return pose;
}

std::vector<Pose> joint_frames(const Chain& chain, ConstVectorRef q, const Load& load) {
  std::vector<Pose> frames;
  for (const JointPlacement& joint : joint_placements(chain, q, load)) frames.push_back(joint.frame);
  return frames;
}

Twists jacobian(const Chain& chain, ConstVectorRef q, const Load& load) {
  const std::vector<JointPlacement> placed = joint_placements(chain, q, load);
  const Vec3 tool = tool_pose(chain, placed).position;
  const std::vector<int> index = active_joint_indices(chain);
  const double stretch = 1.0 + chain.expansion * load.temperature_rise;
  Twists twists = Twists::Zero(6, q.size());
  for (const int j : path_to(chain, chain.tip_joint())) {
    const Joint& joint = chain.joints[j];
    const Eigen::Matrix<double, 6, 1> twist = screw(joint.type, placed[j], tool, stretch);
    if (index[j] >= 0) twists.col(index[j]) += joint.gain * twist;
    for (const Coupling& c : joint.couplings) twists.col(index[c.joint]) += c.factor * twist;
  }
  if (!chain.field.empty()) twists.topRows<3>() += chain.base.pose().rotation * displacement_slope(chain.field, q);
  return twists;
}

VectorXd gravity_torques(const Chain& chain, ConstVectorRef q, const Load& load) {
  return gravity_torques(chain, compute_placements(chain, joint_displacements(chain, q)), load);
}

VectorXd gravity_torques(const Chain& chain, const std::vector<JointPlacement>& placed, const Load& load) {
  VectorXd torques;
  gravity_torques(chain, placed, load, torques);
  return torques;
}

void gravity_torques(const Chain& chain, const std::vector<JointPlacement>& placed, const Load& load,
                     VectorXd& torques) {
  // Column j: first moment about the world's origin and mass of everything carried by joint j.
  thread_local Eigen::Matrix4Xd carried_mass;  // kept between calls: runs at every pose of every fit
  carried_mass.setZero(4, static_cast<Eigen::Index>(placed.size()));
  const auto add_mass = [&](int joint, double mass, const Vec3& at) {
    carried_mass.col(joint) += mass * at.homogeneous();
  };
  for (const PointMass& m : chain.masses) add_mass(m.joint, m.mass, placed[m.joint].frame * m.com);
  if (chain.tip_joint() >= 0) add_mass(chain.tip_joint(), load.payload, tool_pose(chain, placed).position);
  torques.setZero(carried_mass.cols());
  for (Eigen::Index j = carried_mass.cols() - 1; j >= 0; --j) {
    const Joint& joint = chain.joints[j];
    if (rotates(joint.type)) {
      const Vec3 lever = carried_mass.col(j).head<3>() - carried_mass(3, j) * placed[j].point;  // [kg m]
      torques[j] = placed[j].axis.dot(lever.cross(chain.gravity));
    }
    if (joint.parent >= 0) carried_mass.col(joint.parent) += carried_mass.col(j);
  }
}

}  // namespace kinfer
