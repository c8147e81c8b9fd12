// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/calibration/unknown_robot.hpp"

#include "kinfer/base/angle.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string sentence(const AxisPair& axes) {
  const std::string_view id = name(axes.relation);
  const std::string pair = axes.first + " and " + axes.second;
  const double angle = axes.angle / degree, distance = 1e3 * axes.distance.value_or(0.0);
  switch (axes.relation) {
    case AxisRelation::parallel:
      return axes.distance ? phrase(id, "{} are parallel ({:.3f} deg), {:.2f} mm apart", pair, angle, distance)
                           : phrase(id, "{} are parallel ({:.3f} deg)", pair, angle);
    case AxisRelation::at_angle:
      return phrase(id, "{} are at {:.2f} deg to each other", pair, angle);
    case AxisRelation::intersecting:
      return phrase(id, "{} intersect ({:.3f} mm) at {:.2f} deg", pair, distance, angle);
    case AxisRelation::skew:
      return phrase(id, "{} pass each other {:.2f} mm apart, at {:.2f} deg", pair, distance, angle);
  }
  return "";
}

}  // namespace

std::vector<std::string> axis_sentences(const AxisGeometry& axes) {
  std::vector<std::string> list;
  for (const AxisPair& pair : axes.pairs) list.push_back(sentence(pair));
  for (const auto& [first, second, third] : axes.wrists)
    list.push_back(phrase("wrist", "{}, {} and {} meet in one point: a wrist", first, second, third));
  return list;
}

std::vector<std::string> unknown_robot_sentences(const UnknownRobotEvidence& robot) {
  std::vector<std::string> list{phrase(
      "unknown_robot",
      "the robot was found from its joint types and the measurements: {} of {} generic starts came to the same chain, "
      "which leaves {:.3f} mm; a data sheet rounded to 1 mm and 1 deg was the nominal model",
      robot.agreeing, robot.starts, 1e3 * robot.median_error)};
  for (std::string& text : axis_sentences(robot.axes)) list.push_back(std::move(text));
  return list;
}

}  // namespace kinfer::words
