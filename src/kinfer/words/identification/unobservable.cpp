// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/identification/unobservable.hpp"

#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

/// "[0.00 0.71 0.71]"; no negative zero.
std::string direction_text(const Vec3& v) {
  const Vec3 rounded = (100.0 * v).array().round() / 100.0 + 0.0;
  return fmt::format("[{:.2f} {:.2f} {:.2f}]", rounded.x(), rounded.y(), rounded.z());
}

std::string point_text(const JointEstimate& joint) {
  return joint.type == EstimatedJointType::spherical || joint.type == EstimatedJointType::universal
             ? "the centre of the joint"
             : "the axis";
}

}  // namespace

std::string unobservable_text(const Unobservable& u, const JointEstimate& joint) {
  switch (u.kind) {
    case UnobservableKind::point:
      return phrase("point", "where {} is in {}, which does not rotate", point_text(joint), u.sensor);
    case UnobservableKind::point_across:
      return phrase("point_across", "shifts of {} in {} across {}", point_text(joint), u.sensor,
                    direction_text(u.directions[0].cross(u.directions[1])));
    case UnobservableKind::point_along:
      return phrase("point_along", "shifts of {} in {} along {}, the only axis that this segment rotates about",
                    point_text(joint), u.sensor, direction_text(u.directions[0]));
    case UnobservableKind::azimuth:
      return phrase("azimuth", "the azimuth of {} about this axis, which is vertical and keeps its direction",
                    u.sensor);
    case UnobservableKind::place_about_axis:
      return phrase("place_about_axis",
                    "the direction and the place of {} in {} about the axis of {}, which is vertical and keeps its "
                    "direction",
                    point_text(joint), u.sensor, u.other_joint);
    case UnobservableKind::point_on_axis:
      return phrase("point_on_axis", "the joint's point along its own axis");
    case UnobservableKind::axis_position:
      return phrase("axis_position", "the position of the prismatic joint across its axis");
    case UnobservableKind::joint_axis:
      return phrase("joint_axis", "the axis of a joint, if there is one");
    case UnobservableKind::offset_split:
      break;
  }
  return phrase("offset_split", "d of this joint and of {}, whose axis is parallel, other than their sum",
                u.other_joint);
}

std::string remedy_text(const Unobservable& u) {
  switch (u.kind) {
    case UnobservableKind::point:
      return phrase("point.remedy",
                    "rock or drive the machine's base while recording, or measure from the sensor with a tape");
    case UnobservableKind::point_across:
      return phrase("point_across.remedy", "rotate this segment about more directions, or measure with a tape");
    case UnobservableKind::point_along:
      return phrase("point_along.remedy", "rock the machine's base while recording, or measure with a tape");
    case UnobservableKind::azimuth:
      return phrase("azimuth.remedy", "record once more on a slope, or with a magnetometer");
    case UnobservableKind::place_about_axis:
      return phrase("place_about_axis.remedy",
                    "record once more on a slope, or with a magnetometer, as for the azimuth of {}", u.sensor);
    case UnobservableKind::point_on_axis:
      return phrase("point_on_axis.remedy", "any point of the axis will do");
    case UnobservableKind::axis_position:
      return phrase("axis_position.remedy", "any parallel line will do");
    case UnobservableKind::joint_axis:
      return phrase("joint_axis.remedy", "move it");
    case UnobservableKind::offset_split:
      break;
  }
  return phrase("offset_split.remedy", "choose one freely");
}

std::vector<std::string> unobservable_sentences(const JointEstimate& joint) {
  std::vector<std::string> sentences;
  for (const Unobservable& u : joint.unobservable)
    sentences.push_back(unobservable_text(u, joint) + ": " + remedy_text(u));
  return sentences;
}

}  // namespace kinfer::words
