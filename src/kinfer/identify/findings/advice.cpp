// SPDX-License-Identifier: Apache-2.0
// Recommendations after an identification.
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kinfer/identify/findings/forecast.hpp"
#include "kinfer/identify/findings/motion_evidence.hpp"

namespace kinfer::identify {
namespace {

void recommend_use(const Identification& found, std::vector<Advice>& list) {
  if (found.use)
    list.push_back({"Put it to use: the chain is in chain.toml, chain.urdf, chain.mjcf and chain_dh.csv",
                    "each holds every joint in the frames of the INS beside it"});
}

void recommend_sequential_motion(const Identification& found, std::vector<Advice>& list) {
  constexpr double safe_margin = 2.0;
  if (found.order.margin >= safe_margin) return;
  list.push_back({"Move one joint after the other, each for several seconds, and identify again",
                  fmt::format("another order of the segments fits almost as well (margin {:.2f}; {:.0f} is safe)",
                              found.order.margin, safe_margin)});
}

void recommend_moving_rigid_joints(const Identification& found, std::vector<Advice>& list) {
  for (const JointEstimate& joint : found.joints)
    if (joint.type == EstimatedJointType::rigid)
      list.push_back({fmt::format("Move the joint between {} and {}", joint.parent, joint.child),
                      "the two never moved against each other, so nothing is known about a joint there"});
}

/// Unobservable on level ground with a base that does not rock: rotations about the vertical axis and its location.
void recommend_slope(const Identification& found, std::vector<Advice>& list) {
  std::vector<std::string> unobservable_items, places;
  for (const JointEstimate& joint : found.joints) {
    if (joint.azimuth_unobservable)
      unobservable_items.push_back(fmt::format("the turn of {} about the axis", joint.child));
    if (!joint.unobservable_in_parent.empty()) places.push_back(joint.parent);
  }
  for (const JointForecast& f : found.forecast)
    if (is_azimuth_uncertain(f)) unobservable_items.push_back(azimuth_text(f));
  if (!places.empty()) unobservable_items.push_back(fmt::format("places in {}", fmt::join(places, " and in ")));
  if (!unobservable_items.empty())
    list.push_back(
        {"Drive once on a slope and let the base rock, or measure with a tape, if positions are wanted from "
         "the root",
         fmt::format("level ground hides {}; the joints beyond do not need it",
                     fmt::join(unobservable_items, ", and "))});
}

void recommend_more_excitation(const Identification& found, std::vector<Advice>& list) {
  for (const JointForecast& f : found.forecast)
    if (!f.is_sufficient)
      list.push_back(
          {more_excitation_suffices(f)
               ? fmt::format("Move {} further and faster: {:.1f} times the acceleration, or {:.1f} times as long",
                             f.joint, f.acceleration_factor, f.time_factor)
               : fmt::format("Look at the sensors beside {}: mount them firmly, then move it much further", f.joint),
           fmt::format("its line is known to {:.1f} mm and its direction to {:.1f} mrad only", 1e3 * f.line_sd,
                       1e3 * f.direction_sd)});
}

/// End segments: the position of the tool relative to the last sensor is unobservable.
void recommend_tool_measurement(const Identification& found, std::vector<Advice>& list) {
  for (const JointEstimate& joint : found.joints) {
    if (std::ranges::any_of(found.joints, [&](const JointEstimate& other) { return other.parent == joint.child; }))
      continue;
    list.push_back({fmt::format("Measure where the tool is in {} with a tape, or touch one known point", joint.child),
                    "no signal tells what lies beyond the last INS"});
  }
}

}  // namespace

std::vector<Advice> identification_advice(const Identification& found) {
  std::vector<Advice> list;
  recommend_sequential_motion(found, list);
  recommend_use(found, list);
  recommend_moving_rigid_joints(found, list);
  recommend_more_excitation(found, list);
  recommend_slope(found, list);
  recommend_tool_measurement(found, list);
  return list;
}

}  // namespace kinfer::identify
