#include "kinfer/identify/hidden_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kinfer {
namespace {

constexpr double nearly_parallel = 0.05;  // [rad]

std::string direction_text(const Vec3& v) {
  const Vec3 rounded = (100.0 * v).array().round() / 100.0 + 0.0;  // + 0.0: no "-0.00"
  return fmt::format("[{:.2f} {:.2f} {:.2f}]", rounded.x(), rounded.y(), rounded.z());
}

std::string place_words(const FoundJoint& joint) {
  return joint.type == FoundJointType::spherical || joint.type == FoundJointType::universal ? "the centre of the joint"
                                                                                            : "the axis";
}

void say_hidden_place(FoundJoint& joint, const std::vector<Vec3>& hidden, const std::string& sensor) {
  if (hidden.size() == 3)
    joint.not_identifiable.push_back(
        fmt::format("where {} is in {}, which does not turn: rock or drive the machine's base while recording, or "
                    "measure from the sensor with a tape",
                    place_words(joint), sensor));
  else if (hidden.size() == 2)
    joint.not_identifiable.push_back(
        fmt::format("shifts of {} in {} across {}: turn this segment about more directions, or measure with a tape",
                    place_words(joint), sensor, direction_text(hidden[0].cross(hidden[1]))));
  else if (hidden.size() == 1)
    joint.not_identifiable.push_back(
        fmt::format("shifts of {} in {} along {}, the only direction that this segment turns about: rock the machine's "
                    "base while recording, or measure with a tape",
                    place_words(joint), sensor, direction_text(hidden[0])));
}

void say_azimuth(FoundJoint& joint) {
  if (joint.azimuth_undetermined)
    joint.not_identifiable.push_back(
        fmt::format("the azimuth of {} about this axis, which always points the same way and stands upright: record "
                    "once more on a slope, or with a magnetometer",
                    joint.child));
}

void say_own_axis(FoundJoint& joint) {
  if (joint.type == FoundJointType::revolute)
    joint.not_identifiable.emplace_back("the joint's point along its own axis: any point of the axis does");
  if (joint.type == FoundJointType::prismatic)
    joint.not_identifiable.emplace_back("the place of the slide across its axis: any parallel line does");
  if (joint.type == FoundJointType::rigid)
    joint.not_identifiable.emplace_back("the axis of a joint, if there is one: move it");
}

void say_parallel(FoundJoint& joint, const FoundJoint& before) {
  if (before.child != joint.parent || before.type != FoundJointType::revolute || joint.type != FoundJointType::revolute)
    return;
  if (std::min(angle_between(before.axis_in_child, joint.axis_in_parent),
               angle_between(before.axis_in_child, Vec3(-joint.axis_in_parent))) < nearly_parallel)
    joint.not_identifiable.push_back(
        fmt::format("d of this joint and of {}-{}, whose axis is parallel, other than their sum: choose one freely",
                    before.parent, before.child));
}

}  // namespace

void say_what_is_hidden(std::vector<FoundJoint>& joints) {
  for (FoundJoint& joint : joints) {
    joint.not_identifiable.clear();
    say_hidden_place(joint, joint.not_identifiable_in_parent, joint.parent);
    say_hidden_place(joint, joint.not_identifiable_in_child, joint.child);
    say_azimuth(joint);
    say_own_axis(joint);
    for (const FoundJoint& before : joints) say_parallel(joint, before);
  }
}

}  // namespace kinfer
