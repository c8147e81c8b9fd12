// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/forecast.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace kinfer::identify {
namespace {

constexpr double factor_95_percent = 1.96;
constexpr double unobservable_above = 0.5;  // [m], [rad] a standard deviation as large as the prior's: unobservable

/// The two directions across an axis combined, without the unobservable ones.
double sd_across_axis(const std::array<double, 2>& sd) {
  return std::hypot(sd[0] < unobservable_above ? sd[0] : 0.0, sd[1] < unobservable_above ? sd[1] : 0.0);
}

JointForecast forecast(const JointEstimate& joint, const AccuracyTarget& target) {
  JointForecast f{.joint = joint.parent + "-" + joint.child};
  f.line_sd = sd_across_axis(joint.sd.point_in_child);
  f.direction_sd = sd_across_axis(joint.sd.axis_in_child);
  if (joint.unobservable_in_parent.empty()) {
    f.line_sd = std::max(f.line_sd, sd_across_axis(joint.sd.point_in_parent));
    f.direction_sd = std::max(f.direction_sd, sd_across_axis(joint.sd.axis_in_parent));
  } else {
    f.azimuth_of = joint.parent;
    f.azimuth_sd = std::hypot(joint.sd.axis_in_parent[0], joint.sd.axis_in_parent[1]);
  }
  f.acceleration_factor =
      std::max(factor_95_percent * f.line_sd / target.line, factor_95_percent * f.direction_sd / target.direction);
  f.time_factor = f.acceleration_factor * f.acceleration_factor;
  f.is_sufficient = f.acceleration_factor <= 1.0;
  return f;
}

}  // namespace

std::vector<JointForecast> forecast(const std::vector<JointEstimate>& joints, const AccuracyTarget& target) {
  std::vector<JointForecast> all;
  for (const JointEstimate& joint : joints)
    if (joint.type != EstimatedJointType::rigid) all.push_back(forecast(joint, target));
  return all;
}

bool all_sufficient(const std::vector<JointForecast>& joints) {
  return std::ranges::all_of(joints, &JointForecast::is_sufficient);
}

bool is_azimuth_uncertain(const JointForecast& joint, const AccuracyTarget& target) {
  return !joint.azimuth_of.empty() && factor_95_percent * joint.azimuth_sd > target.direction;
}

bool more_excitation_suffices(const JointForecast& joint) {
  constexpr double max_factor = 10.0;  // factor on the acceleration: beyond any machine's reserve
  return joint.acceleration_factor <= max_factor;
}

std::string insufficient_joints_text(const std::vector<JointForecast>& joints) {
  std::vector<std::string> insufficient;
  for (const JointForecast& f : joints)
    if (!f.is_sufficient)
      insufficient.push_back(more_excitation_suffices(f)
                                 ? fmt::format("{} ({:.1f} times the acceleration, or {:.1f} times the time)", f.joint,
                                               f.acceleration_factor, f.time_factor)
                                 : fmt::format("{} (± {:.0f} mm and ± {:.0f} mrad, more than a longer drive mends)",
                                               f.joint, 1e3 * f.line_sd, 1e3 * f.direction_sd));
  return fmt::format("{}", fmt::join(insufficient, ", "));
}

std::string azimuth_text(const JointForecast& joint) {
  return fmt::format(
      "the turn of {} about its only axis ({})", joint.azimuth_of,
      joint.azimuth_sd < unobservable_above ? fmt::format("± {:.0f} mrad", 1e3 * joint.azimuth_sd) : "not known");
}

std::string accuracy_text(const std::vector<JointForecast>& joints) {
  double line = 0.0, direction = 0.0;
  for (const JointForecast& f : joints)
    line = std::max(line, f.line_sd), direction = std::max(direction, f.direction_sd);
  return line > 0.0 ? fmt::format("± {:.1f} mm and ± {:.2f} mrad", 1e3 * line, 1e3 * direction) : "";
}

std::string forecast_text(const std::vector<JointForecast>& joints, const AccuracyTarget& target) {
  const std::string accuracy = fmt::format("{:g} mm and {:g} mrad", 1e3 * target.line, 1e3 * target.direction);
  std::string text = all_sufficient(joints)
                         ? fmt::format("enough for {} in every joint", accuracy)
                         : fmt::format("not enough for {} in {}", accuracy, insufficient_joints_text(joints));
  std::vector<std::string> exceptions;
  if (std::ranges::any_of(joints, [](const JointForecast& f) { return !f.azimuth_of.empty(); }))
    exceptions.emplace_back("places that no signal tells");
  for (const JointForecast& f : joints)
    if (is_azimuth_uncertain(f, target)) exceptions.push_back(azimuth_text(f));
  return exceptions.empty() ? text : text + fmt::format(", but for {}", fmt::join(exceptions, " and "));
}

}  // namespace kinfer::identify
