// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/chain_view.hpp"

#include <cmath>

#include "kinfer/kinematics/elementary_motions.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

/// A joint's transform, split at its motion.
struct SplitJoint {
  Pose before, after;
  Vec3 axis = Vec3::Zero();
  bool is_split = false;

  void operator()(const elementary::Factor& factor) {
    elementary::apply(is_split ? after : before, factor.motion, factor.axis, factor.value);
    if (!factor.moves) return;
    axis = Vec3::Unit(factor.axis);
    is_split = true;
  }
  void operator()(const Mat3& rotation) {
    Pose& pose = is_split ? after : before;
    pose.rotation = pose.rotation * rotation;
  }
};

JointView joint_view(const Joint& joint, const std::vector<int>& q_indices, int q_index) {
  SplitJoint parts;
  elementary::for_each_factor(joint, [&](const auto& step) { parts(step); });
  JointView view{.name = joint.name,
                 .parent = joint.parent,
                 .type = joint.type,
                 .q_index = q_index,
                 .before = view_pose(parts.before),
                 .axis = parts.axis,
                 .after = view_pose(parts.after),
                 .gain = joint.gain};
  for (const Coupling& c : joint.couplings)
    view.couplings.emplace_back(q_indices[static_cast<std::size_t>(c.joint)], c.factor);
  if (std::isfinite(joint.lower) && std::isfinite(joint.upper)) view.limits = {joint.lower, joint.upper};
  return view;
}

double displacement(const JointView& joint, const std::vector<double>& q) {
  const auto value = [&](int k) {
    return k >= 0 && k < static_cast<int>(q.size()) ? q[static_cast<std::size_t>(k)] : 0.0;
  };
  double sum = joint.gain * value(joint.q_index);
  for (const auto& [k, factor] : joint.couplings) sum += factor * value(k);
  return sum;
}

Pose moved(const JointView& joint, double value) {
  if (translates(joint.type)) return {Mat3::Identity(), value * joint.axis};
  if (!rotates(joint.type)) return {};
  return {Eigen::AngleAxisd(value, joint.axis).toRotationMatrix(), Vec3::Zero()};
}

}  // namespace

Pose ViewPose::pose() const {
  return {Quat(quat[0], quat[1], quat[2], quat[3]).normalized().toRotationMatrix(), xyz};
}

ViewPose view_pose(const Pose& pose) {
  const Quat q(pose.rotation);
  return {pose.position, {q.w(), q.x(), q.y(), q.z()}};
}

ChainView chain_view(const Chain& chain) {
  const std::vector<int> q_indices = active_joint_indices(chain);
  ChainView view{.name = chain.name,
                 .base = view_pose(chain.base.pose()),
                 .tip = chain.tip_joint(),
                 .tool = view_pose(chain.tool.pose()),
                 .joint_variables = active_joint_names(chain)};
  for (std::size_t i = 0; i < chain.joints.size(); ++i)
    view.joints.push_back(joint_view(chain.joints[i], q_indices, q_indices[i]));
  for (const Target& target : chain.targets) view.targets.push_back({target.name, target.xyz});
  return view;
}

std::vector<JointViewPlacement> place_joints(const ChainView& chain, const std::vector<double>& q) {
  std::vector<JointViewPlacement> placed;
  for (const JointView& joint : chain.joints) {
    const Pose parent = joint.parent < 0 ? chain.base.pose() : placed[static_cast<std::size_t>(joint.parent)].frame;
    const Pose before = parent * joint.before.pose();
    placed.push_back({before * moved(joint, displacement(joint, q)) * joint.after.pose(), before.rotation * joint.axis,
                      before.position});
  }
  return placed;
}

Pose tool_pose(const ChainView& chain, const std::vector<JointViewPlacement>& joints) {
  const Pose tip = chain.tip < 0 ? chain.base.pose() : joints[static_cast<std::size_t>(chain.tip)].frame;
  return tip * chain.tool.pose();
}

}  // namespace kinfer
