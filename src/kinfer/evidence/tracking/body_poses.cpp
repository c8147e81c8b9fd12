// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/tracking/body_poses.hpp"

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

Mat3 joint_rotation(TrackingMotion motion, ConstVectorRef q) {
  if (motion == TrackingMotion::revolute) return rot_z(q[0]);
  if (motion == TrackingMotion::spherical) return rot_x(q[0]) * rot_y(q[1]) * rot_z(q[2]);
  return Mat3::Identity();
}

}  // namespace

Pose body_pose(const TrackingBody& body, ConstVectorRef positions) {
  KINFER_EXPECT(positions.size() == degrees_of_freedom(body.motion));
  Pose pose;
  pose.rotation = body.parent_R_axis * joint_rotation(body.motion, positions) * body.child_R_axis.transpose();
  Vec3 in_parent = body.point_in_parent;
  if (body.motion == TrackingMotion::prismatic) in_parent += positions[0] * body.parent_R_axis.col(2);
  pose.position = in_parent - pose.rotation * body.point_in_child;
  return pose;
}

std::vector<Pose> body_poses(const TrackingModel& model, ConstVectorRef q) {
  KINFER_EXPECT(q.size() == model.positions());
  std::vector<Pose> poses(1);
  Eigen::Index next = 0;
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const TrackingBody& body = model.bodies[b];
    const int count = degrees_of_freedom(body.motion);
    poses.push_back(poses[static_cast<std::size_t>(body.parent)] * body_pose(body, q.segment(next, count)));
    next += count;
  }
  return poses;
}

Pose tool_pose(const TrackingModel& model, const std::vector<Pose>& bodies) {
  return bodies[static_cast<std::size_t>(model.tool.body)] * model.tool.body_T_tool;
}

}  // namespace kinfer
