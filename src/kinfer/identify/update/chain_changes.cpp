// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/update/chain_changes.hpp"

#include <algorithm>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/identify/handover/known_joint.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

/// Number of joints at each body's segment.
std::size_t joints_at(const TrackingModel& model, int body) {
  return static_cast<std::size_t>(std::ranges::count(model.bodies, body, &TrackingBody::parent)) +
         (model.bodies[static_cast<std::size_t>(body)].joint >= 0 ? 1 : 0);
}

/// The joint at a segment without another.
std::string only_joint(const TrackingModel& model, int body) {
  if (joints_at(model, body) != 1) return {};
  for (const KnownJoint& joint : known_joints(model))
    for (const std::string& sensor : {joint.parent, joint.child})
      if (joint.type != EstimatedJointType::rigid &&
          sensor == model.sensors[static_cast<std::size_t>(model.bodies[static_cast<std::size_t>(body)].sensor)].name)
        return joint.parent + "-" + joint.child;
  return {};
}

/// What is expressed in a frame that was rotated by `r` and shifted by `t` in itself.
void move_frame(Mat3& axes, Vec3& point, const Mat3& r, const Vec3& t) {
  axes = r.transpose() * axes;
  point = r.transpose() * (point - t);
}

void move_sensor(TrackingModel& model, int body, const Vec3& rotation, const Vec3& shift) {
  const Mat3 r = exp_so3(rotation);
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    TrackingBody& other = model.bodies[b];
    if (other.parent == body) move_frame(other.parent_R_axis, other.point_in_parent, r, shift);
    if (static_cast<int>(b) == body) move_frame(other.child_R_axis, other.point_in_child, r, shift);
  }
}

void move_joint(TrackingBody& body, bool in_parent, const Eigen::Vector2d& rotation, const Vec3& shift) {
  Mat3& axes = in_parent ? body.parent_R_axis : body.child_R_axis;
  Vec3& point = in_parent ? body.point_in_parent : body.point_in_child;
  point += axes * shift;
  axes = axes * exp_so3(Vec3(rotation.x(), rotation.y(), 0.0));
}

}  // namespace

std::vector<ChainCause> possible_causes(const TrackingModel& model) {
  std::vector<ChainCause> causes;
  for (const TrackingSensor& sensor : model.sensors)
    causes.push_back({.kind = ChainChangeKind::sensor_moved,
                      .name = sensor.name,
                      .segment = sensor.name,
                      .alternative = only_joint(model, sensor.body),
                      .body = sensor.body});
  const std::vector<KnownJoint> joints = known_joints(model);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].type == EstimatedJointType::rigid) continue;
    const std::vector<std::size_t> bodies = bodies_of_joint(model, j);
    const std::string name = joints[j].parent + "-" + joints[j].child;
    const int parent = model.bodies[bodies.front()].parent;
    if (joints_at(model, parent) > 1)
      causes.push_back({.kind = ChainChangeKind::joint_moved,
                        .name = name,
                        .segment = joints[j].parent,
                        .body = static_cast<int>(bodies.front()),
                        .in_parent = true});
    if (joints_at(model, static_cast<int>(bodies.back())) > 1)
      causes.push_back({.kind = ChainChangeKind::joint_moved,
                        .name = name,
                        .segment = joints[j].child,
                        .body = static_cast<int>(bodies.back())});
  }
  return causes;
}

Index rotations_of(const ChainCause& cause) {
  return cause.kind == ChainChangeKind::sensor_moved ? sensor_rotations : joint_rotations;
}

Index components_of(const ChainCause& cause) {
  return rotations_of(cause) + 3;
}

TrackingBodies changed_bodies(const TrackingModel& model, const ChainCause& cause, ConstVectorRef size) {
  TrackingModel result = without_covariance(model);
  if (cause.kind == ChainChangeKind::sensor_moved)
    move_sensor(result, cause.body, size.head<3>(), size.tail<3>());
  else
    move_joint(result.bodies[static_cast<std::size_t>(cause.body)], cause.in_parent, size.head<2>(), size.tail<3>());
  return aligned(result, model);
}

TrackingModel changed(const TrackingModel& model, const ChainCause& cause, ConstVectorRef size) {
  const VectorXd fixed = size;
  TrackingModel result =
      transported(model, [&](const TrackingModel& one) { return changed_bodies(one, cause, fixed); });
  if (cause.kind == ChainChangeKind::sensor_moved && result.tool.body == cause.body)
    result.tool.body_T_tool = Pose{exp_so3(size.head<3>()), size.tail<3>()}.inverse() * result.tool.body_T_tool;
  return result;
}

MatrixXd effect_of(const TrackingModel& model, const ChainCause& cause,
                   const std::vector<TrackingParameter>& parameters) {
  constexpr double step = 1e-6;  // [rad], [m]
  const Index components = components_of(cause);
  MatrixXd effect(static_cast<Index>(parameters.size()), components);
  for (Index k = 0; k < components; ++k) {
    const VectorXd unit = step * VectorXd::Unit(components, k);
    effect.col(k) =
        difference(changed_bodies(model, cause, -unit), changed_bodies(model, cause, unit), parameters) / (2.0 * step);
  }
  return effect;
}

}  // namespace kinfer::identify
