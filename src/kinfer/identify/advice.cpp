// What to do next after an identification.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/identify/forecast.hpp"
#include "kinfer/identify/motion_evidence.hpp"

namespace kinfer {
namespace {

void make_the_order_safe(const Identification& found, std::vector<Advice>& list) {
  constexpr double safe_margin = 2.0;
  if (found.order.margin >= safe_margin) return;
  list.push_back({"Move one joint after the other, each for several seconds, and identify again",
                  fmt::format("another order of the segments fits almost as well (margin {:.2f}; {:.0f} is safe)",
                              found.order.margin, safe_margin)});
}

void move_what_stood_still(const Identification& found, std::vector<Advice>& list) {
  for (const FoundJoint& joint : found.joints)
    if (joint.type == FoundJointType::rigid)
      list.push_back({fmt::format("Move the joint between {} and {}", joint.parent, joint.child),
                      "the two never moved against each other, so nothing is known about a joint there"});
}

void fix_azimuths(const Identification& found, std::vector<Advice>& list) {
  for (const FoundJoint& joint : found.joints)
    if (joint.azimuth_undetermined)
      list.push_back(
          {fmt::format("Drive once on a slope, or note how the INS {} is turned about the axis", joint.child),
           "its turn about the vertical axis leaves no trace in any signal"});
  for (const JointForecast& f : found.forecast)
    if (is_vague_azimuth(f))
      list.push_back(
          {fmt::format("Drive once on a slope, or let the base rock, if the heading of {} matters", f.joint),
           fmt::format("how {} is turned about its only axis is known to {:.0f} mrad; on level ground hardly "
                       "any signal tells it",
                       f.azimuth_of, 1e3 * f.azimuth_sd)});
}

void move_more(const Identification& found, std::vector<Advice>& list) {
  for (const JointForecast& f : found.forecast)
    if (!f.enough)
      list.push_back({fmt::format("Move {} further and faster: {:.1f} times the acceleration, or {:.1f} times as long",
                                  f.joint, f.acceleration, f.time),
                      fmt::format("its line is known to {:.1f} mm and its direction to {:.1f} mrad only",
                                  1e3 * f.line_sd, 1e3 * f.direction_sd)});
}

/// The sensors that carry no further joint: what lies beyond them moves with them unseen.
void touch_the_tool(const Identification& found, std::vector<Advice>& list) {
  for (const FoundJoint& joint : found.joints) {
    if (std::ranges::any_of(found.joints, [&](const FoundJoint& other) { return other.parent == joint.child; }))
      continue;
    list.push_back({fmt::format("Measure where the tool is in {} with a tape, or touch one known point", joint.child),
                    "no signal tells what lies beyond the last INS"});
  }
}

}  // namespace

std::vector<Advice> identification_advice(const Identification& found) {
  std::vector<Advice> list;
  make_the_order_safe(found, list);
  move_what_stood_still(found, list);
  move_more(found, list);
  fix_azimuths(found, list);
  touch_the_tool(found, list);
  return list;
}

}  // namespace kinfer
