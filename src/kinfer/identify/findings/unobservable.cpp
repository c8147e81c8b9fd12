// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/unobservable.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kinfer::identify {
namespace {

constexpr double nearly_parallel = 0.05;  // [rad]

std::string direction_text(const Vec3& v) {
  const Vec3 rounded = (100.0 * v).array().round() / 100.0 + 0.0;  // + 0.0: no "-0.00"
  return fmt::format("[{:.2f} {:.2f} {:.2f}]", rounded.x(), rounded.y(), rounded.z());
}

std::string point_text(const JointEstimate& joint) {
  return joint.type == EstimatedJointType::spherical || joint.type == EstimatedJointType::universal
             ? "the centre of the joint"
             : "the axis";
}

void add_point_sentence(JointEstimate& joint, const std::vector<Vec3>& directions, const std::string& sensor) {
  if (directions.size() == 3)
    joint.unobservable.push_back(
        fmt::format("where {} is in {}, which does not turn: rock or drive the machine's base while recording, or "
                    "measure from the sensor with a tape",
                    point_text(joint), sensor));
  else if (directions.size() == 2)
    joint.unobservable.push_back(
        fmt::format("shifts of {} in {} across {}: turn this segment about more directions, or measure with a tape",
                    point_text(joint), sensor, direction_text(directions[0].cross(directions[1]))));
  else if (directions.size() == 1)
    joint.unobservable.push_back(
        fmt::format("shifts of {} in {} along {}, the only direction that this segment turns about: rock the machine's "
                    "base while recording, or measure with a tape",
                    point_text(joint), sensor, direction_text(directions[0])));
}

void add_azimuth_sentence(JointEstimate& joint) {
  if (joint.azimuth_unobservable)
    joint.unobservable.push_back(
        fmt::format("the azimuth of {} about this axis, which always points the same way and stands upright: record "
                    "once more on a slope, or with a magnetometer",
                    joint.child));
}

void add_axis_sentence(JointEstimate& joint) {
  if (joint.type == EstimatedJointType::revolute)
    joint.unobservable.emplace_back("the joint's point along its own axis: any point of the axis does");
  if (joint.type == EstimatedJointType::prismatic)
    joint.unobservable.emplace_back("the place of the slide across its axis: any parallel line does");
  if (joint.type == EstimatedJointType::rigid)
    joint.unobservable.emplace_back("the axis of a joint, if there is one: move it");
}

void add_parallel_sentence(JointEstimate& joint, const JointEstimate& before) {
  if (before.child != joint.parent || before.type != EstimatedJointType::revolute ||
      joint.type != EstimatedJointType::revolute)
    return;
  if (std::min(angle_between(before.axis_in_child, joint.axis_in_parent),
               angle_between(before.axis_in_child, Vec3(-joint.axis_in_parent))) < nearly_parallel)
    joint.unobservable.push_back(
        fmt::format("d of this joint and of {}-{}, whose axis is parallel, other than their sum: choose one freely",
                    before.parent, before.child));
}

}  // namespace

void list_unobservable(std::vector<JointEstimate>& joints) {
  for (JointEstimate& joint : joints) {
    joint.unobservable.clear();
    add_point_sentence(joint, joint.unobservable_in_parent, joint.parent);
    add_point_sentence(joint, joint.unobservable_in_child, joint.child);
    add_azimuth_sentence(joint);
    add_axis_sentence(joint);
    for (const JointEstimate& before : joints) add_parallel_sentence(joint, before);
  }
}

}  // namespace kinfer::identify
