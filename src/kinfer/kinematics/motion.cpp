#include "kinfer/kinematics/motion.hpp"

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

/// The body's motion, described at another frame of it.
FrameMotion seen_at(const FrameMotion& body, const Pose& pose) {
  const Vec3 arm = pose.position - body.pose.position;
  const Vec3 swing = body.omega.cross(arm);
  return {.pose = pose,
          .omega = body.omega,
          .alpha = body.alpha,
          .velocity = body.velocity + swing,
          .acceleration = body.acceleration + body.alpha.cross(arm) + body.omega.cross(swing)};
}

FrameMotion turned(const FrameMotion& parent, const PlacedJoint& joint, double rate, double acceleration) {
  FrameMotion body =
      seen_at(parent, {parent.pose.rotation, joint.point});  // a point of the axis belongs to both bodies
  body.omega += rate * joint.axis;
  body.alpha += acceleration * joint.axis + rate * parent.omega.cross(joint.axis);
  return seen_at(body, joint.frame);
}

FrameMotion slid(const FrameMotion& parent, const PlacedJoint& joint, double rate, double acceleration) {
  FrameMotion body = seen_at(parent, joint.frame);
  body.velocity += rate * joint.axis;
  body.acceleration += acceleration * joint.axis + 2.0 * rate * parent.omega.cross(joint.axis);  // Coriolis
  return body;
}

}  // namespace

std::vector<FrameMotion> joint_motions(const Chain& chain, ConstVectorRef q, ConstVectorRef qd, ConstVectorRef qdd) {
  KINFER_EXPECT(qd.size() == q.size() && qdd.size() == q.size(), "{}, {}, {}", q.size(), qd.size(), qdd.size());
  const VectorXd moved = moved_by_readings(chain, q), rate = moved_by_readings(chain, qd),
                 acceleration = moved_by_readings(
                     chain,
                     qdd);  // linear in the readings, so rates go the same way; harmonics are too small to matter here
  const FrameMotion base{.pose = chain.base.pose()};
  std::vector<FrameMotion> motions;
  motions.reserve(chain.joints.size());
  for (const Joint& joint : chain.joints) {
    const FrameMotion& parent = joint.parent >= 0 ? motions[joint.parent] : base;
    const auto j = static_cast<Eigen::Index>(motions.size());
    const PlacedJoint placed = place(parent.pose, joint, moved[j]);
    motions.push_back(joint.type == JointType::revolute ? turned(parent, placed, rate[j], acceleration[j])
                                                        : slid(parent, placed, rate[j], acceleration[j]));
  }
  return motions;
}

FrameMotion carried(const FrameMotion& carrier, const Pose& carrier_T_frame) {
  return seen_at(carrier, carrier.pose * carrier_T_frame);
}

}  // namespace kinfer
