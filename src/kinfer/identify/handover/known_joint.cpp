// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/known_joint.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer::identify {
namespace {

using Kind = TrackingParameterKind;

InsBody ins_body(const TrackingBody& body) {
  const Mat3 &a = body.parent_R_axis, &b = body.child_R_axis;
  InsBody result = body.motion == TrackingMotion::revolute    ? revolute_body(-1, -1, a, b)
                   : body.motion == TrackingMotion::prismatic ? prismatic_body(-1, -1, a, b)
                   : body.motion == TrackingMotion::spherical ? spherical_body(-1, -1, a * b.transpose())
                                                              : fixed_body(-1, -1, a * b.transpose());
  result.point_in_parent = body.point_in_parent;
  result.point_in_child = body.point_in_child;
  return result;
}

/// Between the axes of a universal joint only their angle is free; the zero of the first position is in the first
/// body's frame on its far side, which the fit holds at identity.
void make_universal(KnownJoint& joint) {
  InsBody &near = joint.bodies.front(), &far = joint.bodies.back();
  const Mat3 home = near.child_R_axis.transpose();
  joint.zero = {std::atan2(home(1, 0), home(0, 0)), 0.0};
  near.child_R_axis = Mat3::Identity();
  near.free_child_rotation = {};
  far.free_parent_rotation = {false, true, false};
  near.free_point_in_child = far.free_point_in_parent = false;
}

std::string sensor_of(const TrackingModel& model, int body) {
  const int sensor = model.bodies[static_cast<std::size_t>(body)].sensor;
  return sensor < 0 ? std::string() : model.sensors[static_cast<std::size_t>(sensor)].name;
}

std::vector<Eigen::Index> parameters_of(const TrackingModel& model, const std::vector<std::size_t>& bodies) {
  std::vector<Eigen::Index> rows;
  for (const std::size_t body : bodies)
    for (const Kind kind : {Kind::parent_rotation, Kind::child_rotation, Kind::point_in_parent, Kind::point_in_child})
      for (std::size_t i = 0; i < model.parameters.size(); ++i) {
        const TrackingParameter& p = model.parameters[i];
        if (p.kind == kind && p.index == static_cast<int>(body) && !is_zero_of_revolute(model, p))
          rows.push_back(static_cast<Eigen::Index>(i));
      }
  return rows;
}

KnownJoint known_joint(const TrackingModel& model, std::size_t j) {
  const std::vector<std::size_t> bodies = bodies_of_joint(model, j);
  KnownJoint joint{.parent = sensor_of(model, model.bodies[bodies.front()].parent),
                   .child = sensor_of(model, static_cast<int>(bodies.back())),
                   .type = model.joints[j].type,
                   .bodies = {},
                   .zero = {}};
  for (const std::size_t body : bodies) joint.bodies.push_back(ins_body(model.bodies[body]));
  joint.zero.assign(static_cast<std::size_t>(std::max(1, model.joints[j].positions)), 0.0);
  if (joint.type == EstimatedJointType::universal) make_universal(joint);
  if (joint.type == EstimatedJointType::spherical) joint.spherical_axes = model.bodies[bodies.front()].parent_R_axis;
  joint.parameters = parameters_of(model, bodies);
  return joint;
}

}  // namespace

std::vector<std::size_t> bodies_of_joint(const TrackingModel& model, std::size_t joint) {
  std::vector<std::size_t> bodies;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (model.bodies[b].joint == static_cast<int>(joint)) bodies.push_back(b);
  return bodies;
}

bool is_zero_of_revolute(const TrackingModel& model, const TrackingParameter& parameter) {
  return parameter.kind == Kind::child_rotation && parameter.component == 2 &&
         model.bodies[static_cast<std::size_t>(parameter.index)].motion == TrackingMotion::revolute;
}

std::vector<KnownJoint> known_joints(const TrackingModel& model) {
  std::vector<KnownJoint> joints;
  for (std::size_t j = 0; j < model.joints.size(); ++j) joints.push_back(known_joint(model, j));
  return joints;
}

}  // namespace kinfer::identify
