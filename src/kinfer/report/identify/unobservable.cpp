// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/identify/unobservable.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/report/parts/html.hpp"
#include "kinfer/report/parts/units.hpp"

namespace kinfer::report {
namespace {

/// True if something that the user needs is unobservable: a direction or an azimuth. The point along the axis and the
/// split of an offset between parallel axes are free choices and do not count.
bool has_unobservable_direction(const JointEstimate& joint) {
  return !joint.unobservable_in_parent.empty() || !joint.unobservable_in_child.empty() || joint.azimuth_unobservable;
}

/// The first unobservable quantity, without its remedy where the file holds it apart.
std::string first_unobservable(const JointRecord& joint) {
  if (!joint.unobservable.empty()) return joint.unobservable.front().what;
  return joint.sentences.empty() ? "" : joint.sentences.front();
}

/// Sensors of the last segments (leaves of the tree).
std::vector<std::string> leaf_sensors(const std::vector<JointRecord>& joints) {
  std::vector<std::string> leaves;
  for (const JointRecord& joint : joints)
    if (std::ranges::none_of(joints,
                             [&](const JointRecord& other) { return other.estimate.parent == joint.estimate.child; }))
      leaves.push_back(joint.estimate.child);
  return leaves;
}

}  // namespace

std::vector<std::string> uncertain_items(const IdentificationEvidence& e) {
  std::vector<std::string> items;
  for (const JointForecast& f : e.forecast)
    if (mrad * f.azimuth_sd > 1.0)
      items.push_back(fmt::format("the azimuth of <b>{}</b> about its only axis: ±&nbsp;{}&nbsp;mrad",
                                  html::escape(f.azimuth_of), html::fixed(mrad * f.azimuth_sd, 0)));
  for (const JointRecord& joint : e.joints)
    if (const std::string what = first_unobservable(joint); !what.empty() && has_unobservable_direction(joint.estimate))
      items.push_back(fmt::format("<b>{}–{}</b>: {}", html::escape(joint.estimate.parent),
                                  html::escape(joint.estimate.child), html::escape(what)));
  if (e.places.empty())
    for (const std::string& sensor : leaf_sensors(e.joints))
      items.push_back(fmt::format("where the tool is beyond <b>{}</b>", html::escape(sensor)));
  return items;
}

}  // namespace kinfer::report
