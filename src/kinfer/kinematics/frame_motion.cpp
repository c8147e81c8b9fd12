// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/frame_motion.hpp"

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

/// Motion of another frame of the same rigid body.
FrameMotion motion_at(const FrameMotion& body, const Pose& pose) {
  const Vec3 arm = pose.position - body.pose.position;
  const Vec3 tangential = body.omega.cross(arm);
  return {.pose = pose,
          .omega = body.omega,
          .alpha = body.alpha,
          .velocity = body.velocity + tangential,
          .acceleration = body.acceleration + body.alpha.cross(arm) + body.omega.cross(tangential)};
}

FrameMotion through_revolute(const FrameMotion& parent, const JointPlacement& joint, double joint_velocity,
                             double acceleration) {
  FrameMotion body =
      motion_at(parent, {parent.pose.rotation, joint.point});  // a point of the axis belongs to both bodies
  body.omega += joint_velocity * joint.axis;
  body.alpha += acceleration * joint.axis + joint_velocity * parent.omega.cross(joint.axis);
  return motion_at(body, joint.frame);
}

FrameMotion through_prismatic(const FrameMotion& parent, const JointPlacement& joint, double joint_velocity,
                              double acceleration) {
  FrameMotion body = motion_at(parent, joint.frame);
  body.velocity += joint_velocity * joint.axis;
  body.acceleration += acceleration * joint.axis + 2.0 * joint_velocity * parent.omega.cross(joint.axis);  // Coriolis
  return body;
}

}  // namespace

std::vector<FrameMotion> joint_motions(const Chain& chain, ConstVectorRef q, ConstVectorRef qd, ConstVectorRef qdd) {
  KINFER_EXPECT(qd.size() == q.size() && qdd.size() == q.size(), "{}, {}, {}", q.size(), qd.size(), qdd.size());
  const VectorXd displacement = joint_displacements(chain, q), joint_velocity = joint_displacements(chain, qd),
                 acceleration = joint_displacements(
                     chain,
                     qdd);  // linear in q, so velocities transform the same way; harmonics are negligible here
  const FrameMotion base{.pose = chain.base.pose()};
  std::vector<FrameMotion> motions;
  motions.reserve(chain.joints.size());
  for (const Joint& joint : chain.joints) {
    const FrameMotion& parent = joint.parent >= 0 ? motions[joint.parent] : base;
    const auto j = static_cast<Eigen::Index>(motions.size());
    const JointPlacement placement = place_joint(parent.pose, joint, displacement[j]);
    // A fixed joint is a prismatic one that stays at zero.
    motions.push_back(rotates(joint.type) ? through_revolute(parent, placement, joint_velocity[j], acceleration[j])
                                          : through_prismatic(parent, placement, joint_velocity[j], acceleration[j]));
  }
  return motions;
}

FrameMotion attached_frame_motion(const FrameMotion& parent, const Pose& parent_T_frame) {
  return motion_at(parent, parent.pose * parent_T_frame);
}

}  // namespace kinfer
