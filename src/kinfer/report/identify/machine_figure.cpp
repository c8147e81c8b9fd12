// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "kinfer/report/identify/figures.hpp"
#include "kinfer/report/parts/scene.hpp"

namespace kinfer::report {
namespace {

using SensorFrames = std::map<std::string, Pose>;  // world_T_sensor

std::vector<double> column_or_empty(const MatrixXd& q, Eigen::Index frame) {
  if (frame >= q.cols()) return {};
  return {q.col(frame).begin(), q.col(frame).end()};
}

/// At one time of the trajectory.
SensorFrames sensor_frames(const IdentificationEvidence& evidence, Eigen::Index frame) {
  const MachineTrajectory& trajectory = evidence.motion.trajectory;
  ChainView chain = evidence.chain;
  if (const auto& root = trajectory.root; !root.empty())
    chain.base = {Vec3::Zero(), root[std::min(static_cast<std::size_t>(frame), root.size() - 1)]};
  SensorFrames frames{{evidence.root, chain.base.pose()}};
  const auto joints = place_joints(chain, column_or_empty(trajectory.q, frame));
  for (std::size_t i = 0; i < joints.size(); ++i) frames[chain.joints[i].name] = joints[i].frame;
  return frames;
}

void draw_directions(svg::Scene& scene, const std::vector<Vec3>& directions, const Pose& frame, const Vec3& point,
                     double length) {
  for (const Vec3& direction : directions) {
    const Vec3 along = length * (frame.rotation * direction);
    scene.line({point - along, point + along}, "open");
  }
}

void draw_joint(svg::Scene& scene, const IdentificationEvidence& evidence, const JointEstimate& joint,
                const SensorFrames& frames, double size) {
  const auto parent = frames.find(joint.parent), child = frames.find(joint.child);
  if (parent == frames.end() || child == frames.end()) return;
  const bool has_axis = joint.type != EstimatedJointType::spherical;
  const Vec3 point = child->second * joint.point_in_child;
  const Vec3 axis = has_axis ? Vec3(child->second.rotation * joint.axis_in_child) : Vec3(Vec3::Zero());
  draw_directions(scene, joint.unobservable_in_parent, parent->second, point, 0.25 * size);
  draw_directions(scene, joint.unobservable_in_child, child->second, point, 0.25 * size);
  scene.line({point, child->second.position}, "arm");
  scene.line({point - 0.12 * size * axis, point + 0.12 * size * axis}, "joint-axis");
  const auto has_place = [](const JointEstimate& j) {
    return is_point_known(j.sd.point_in_parent, j.unobservable_in_parent);
  };
  for (const JointRecord& next : evidence.joints)
    if (next.estimate.parent == joint.child && has_place(next.estimate))
      scene.line({point, child->second * next.estimate.point_in_parent}, "link");
  if (joint.parent == evidence.root && has_place(joint))
    scene.line({parent->second.position, parent->second * joint.point_in_parent}, "link");
  scene.dot(point, 4.0, "joint");
}

}  // namespace

std::string identified_machine_drawing(const IdentificationEvidence& evidence) {
  const SensorFrames frames = sensor_frames(evidence, evidence.motion.trajectory.q.cols() / 2);
  svg::Scene scene;
  for (const std::string& sensor : evidence.order.sensors) {
    const auto frame = frames.find(sensor);
    if (frame == frames.end()) continue;
    scene.dot(frame->second.position, 5.0, "ins");
    scene.name(frame->second.position, frame->first);
  }
  const double size = 2.0 * scene.radius();
  for (const JointRecord& joint : evidence.joints) draw_joint(scene, evidence, joint.estimate, frames, size);
  return scene.svg({640, 460}, "The identified machine: segments, sensors, joint axes");
}

}  // namespace kinfer::report
