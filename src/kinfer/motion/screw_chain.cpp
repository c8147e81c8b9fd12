// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/screw_chain.hpp"

#include <cmath>
#include <numbers>

#include "kinfer/kinematics/chain_view.hpp"
#include "kinfer/kinematics/elementary_motions.hpp"

namespace kinfer::motion {
namespace {

/// pose = pose · next, in line.
void move_on(Pose& pose, const Pose& next) {
  pose.position += pose.rotation.lazyProduct(next.position);
  pose.rotation = Mat3(pose.rotation.lazyProduct(next.rotation));
}

}  // namespace

ScrewChain::ScrewChain(const Chain& chain) : dof_(kinfer::dof(chain)) {
  for (const int j : active_joints(chain))
    rotational_.push_back(rotates(chain.joints[static_cast<std::size_t>(j)].type));
  const ChainView view = chain_view(chain);
  base_ = view.base.pose();
  Pose since_last = Pose{};
  std::vector<int> uses(static_cast<std::size_t>(dof_), 0);
  for (const int j : path_to(chain, chain.tip_joint())) {
    const JointView& joint = view.joints[static_cast<std::size_t>(j)];
    since_last = since_last * joint.before.pose();
    MovingJoint moving{.before = {}, .rotates = rotates(joint.type), .terms = joint.couplings};
    if (joint.q_index >= 0 && joint.gain != 0.0) moving.terms.emplace_back(joint.q_index, joint.gain);
    if (has_position(joint.type) && !moving.terms.empty()) {
      const Pose parent_T_axis{elementary::rotation_to(joint.axis), Vec3::Zero()};
      moving.before = since_last * parent_T_axis;
      since_last = parent_T_axis.inverse();
      for (const auto& [index, factor] : moving.terms) ++uses[static_cast<std::size_t>(index)];
      joints_.push_back(std::move(moving));
    }
    since_last = since_last * joint.after.pose();
  }
  tool_ = since_last * view.tool.pose();
  period_.assign(static_cast<std::size_t>(dof_), 0.0);
  for (const MovingJoint& joint : joints_)
    for (const auto& [index, factor] : joint.terms)
      if (joint.rotates && uses[static_cast<std::size_t>(index)] == 1)
        period_[static_cast<std::size_t>(index)] = 2.0 * std::numbers::pi / std::abs(factor);
}

void ScrewChain::place(const VectorXd& q, Placement& at) const {
  at.axis.resize(joints_.size()), at.origin.resize(joints_.size());
  Pose pose = base_;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const MovingJoint& joint = joints_[j];
    move_on(pose, joint.before);
    at.axis[j] = pose.rotation.col(2), at.origin[j] = pose.position;
    double variable = 0.0;
    for (const auto& [index, factor] : joint.terms) variable += factor * q[index];
    elementary::apply(pose, joint.rotates ? elementary::Motion::rotation : elementary::Motion::translation, 2,
                      variable);
  }
  at.tool = pose;
  move_on(at.tool, tool_);
}

void ScrewChain::jacobian(const Placement& at, Twists& twists) const {
  twists.setZero(6, dof_);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Vec3& axis = at.axis[j];
    const bool rotates = joints_[j].rotates;
    const Vec3 shift = rotates ? Vec3(axis.cross(at.tool.position - at.origin[j])) : axis;
    for (const auto& [index, factor] : joints_[j].terms) {
      twists.col(index).head<3>() += factor * shift;
      if (rotates) twists.col(index).tail<3>() += factor * axis;
    }
  }
}

}  // namespace kinfer::motion
