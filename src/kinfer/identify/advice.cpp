// What to do next after an identification.
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kinfer/identify/forecast.hpp"
#include "kinfer/identify/motion_evidence.hpp"

namespace kinfer {
namespace {

void put_it_to_use(const Identification& found, std::vector<Advice>& list) {
  if (found.use)
    list.push_back({"Put it to use: the chain is in chain.toml, chain.urdf, chain.mjcf and chain_dh.csv",
                    "each holds every joint in the frames of the INS beside it"});
}

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

/// What a machine on level ground that never rocks cannot show: turns about its upright axis, and where that axis is.
void show_what_level_ground_hides(const Identification& found, std::vector<Advice>& list) {
  std::vector<std::string> hidden, places;
  for (const FoundJoint& joint : found.joints) {
    if (joint.azimuth_undetermined) hidden.push_back(fmt::format("the turn of {} about the axis", joint.child));
    if (!joint.not_identifiable_in_parent.empty()) places.push_back(joint.parent);
  }
  for (const JointForecast& f : found.forecast)
    if (is_vague_azimuth(f)) hidden.push_back(azimuth_in_words(f));
  if (!places.empty()) hidden.push_back(fmt::format("places in {}", fmt::join(places, " and in ")));
  if (!hidden.empty())
    list.push_back(
        {"Drive once on a slope and let the base rock, or measure with a tape, if positions are wanted from "
         "the root",
         fmt::format("level ground hides {}; the joints beyond do not need it", fmt::join(hidden, ", and "))});
}

void move_more(const Identification& found, std::vector<Advice>& list) {
  for (const JointForecast& f : found.forecast)
    if (!f.enough)
      list.push_back(
          {a_drive_would_do(f)
               ? fmt::format("Move {} further and faster: {:.1f} times the acceleration, or {:.1f} times as long",
                             f.joint, f.acceleration, f.time)
               : fmt::format("Look at the sensors beside {}: mount them firmly, then move it much further", f.joint),
           fmt::format("its line is known to {:.1f} mm and its direction to {:.1f} mrad only", 1e3 * f.line_sd,
                       1e3 * f.direction_sd)});
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
  put_it_to_use(found, list);
  move_what_stood_still(found, list);
  move_more(found, list);
  show_what_level_ground_hides(found, list);
  touch_the_tool(found, list);
  return list;
}

}  // namespace kinfer
