// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/unobservable.hpp"

#include <algorithm>

#include "kinfer/identify/findings/thresholds.hpp"

namespace kinfer::identify {
namespace {

/// `directions`: of the joint's point in the sensor's frame.
void add_point(JointEstimate& joint, const std::vector<Vec3>& directions, const std::string& sensor) {
  if (directions.empty()) return;
  const UnobservableKind kind = directions.size() >= 3   ? UnobservableKind::point
                                : directions.size() == 2 ? UnobservableKind::point_across
                                                         : UnobservableKind::point_along;
  joint.unobservable.push_back({.kind = kind, .sensor = sensor, .directions = directions});
}

void add_own_axis(JointEstimate& joint) {
  if (joint.type == EstimatedJointType::revolute)
    joint.unobservable.push_back({.kind = UnobservableKind::point_on_axis});
  if (joint.type == EstimatedJointType::prismatic)
    joint.unobservable.push_back({.kind = UnobservableKind::axis_position});
  if (joint.type == EstimatedJointType::rigid) joint.unobservable.push_back({.kind = UnobservableKind::joint_axis});
}

/// What starts on a body of unknown azimuth may be anywhere about its axis.
void add_place_about_axis(JointEstimate& joint, const std::vector<JointEstimate>& joints) {
  for (const JointEstimate& before : joints)
    if (before.azimuth_unobservable && before.child == joint.parent)
      joint.unobservable.push_back(
          {.kind = UnobservableKind::place_about_axis, .sensor = joint.parent, .other_joint = joint_name(before)});
}

bool are_consecutive_parallel(const JointEstimate& before, const JointEstimate& joint) {
  if (before.child != joint.parent || before.type != EstimatedJointType::revolute ||
      joint.type != EstimatedJointType::revolute)
    return false;
  return std::min(angle_between(before.axis_in_child, joint.axis_in_parent),
                  angle_between(before.axis_in_child, Vec3(-joint.axis_in_parent))) < parallel_axes_angle;
}

}  // namespace

void list_unobservable(std::vector<JointEstimate>& joints) {
  for (JointEstimate& joint : joints) {
    joint.unobservable.clear();
    add_point(joint, joint.unobservable_in_parent, joint.parent);
    add_point(joint, joint.unobservable_in_child, joint.child);
    if (joint.azimuth_unobservable)
      joint.unobservable.push_back({.kind = UnobservableKind::azimuth, .sensor = joint.child});
    add_place_about_axis(joint, joints);
    add_own_axis(joint);
    for (const JointEstimate& before : joints)
      if (are_consecutive_parallel(before, joint))
        joint.unobservable.push_back({.kind = UnobservableKind::offset_split, .other_joint = joint_name(before)});
  }
}

}  // namespace kinfer::identify
