#include "kinfer/identify/forecast.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

constexpr double in_95_of_100 = 1.96;
constexpr double unknowable = 0.5;  // [m], [rad] a standard deviation as large as the prior's: no drive would help

/// Of the two directions across an axis together, as far as they can be known.
double across(const std::array<double, 2>& sd) {
  return std::hypot(sd[0] < unknowable ? sd[0] : 0.0, sd[1] < unknowable ? sd[1] : 0.0);
}

JointForecast forecast(const FoundJoint& joint, const WantedAccuracy& wanted) {
  JointForecast f{.joint = joint.parent + "-" + joint.child};
  f.line_sd = across(joint.sd.point_in_child);
  f.direction_sd = across(joint.sd.axis_in_child);
  if (joint.not_identifiable_in_parent.empty()) {
    f.line_sd = std::max(f.line_sd, across(joint.sd.point_in_parent));
    f.direction_sd = std::max(f.direction_sd, across(joint.sd.axis_in_parent));
  } else {
    f.azimuth_of = joint.parent;
    f.azimuth_sd = std::hypot(joint.sd.axis_in_parent[0], joint.sd.axis_in_parent[1]);
  }
  f.acceleration = std::max(in_95_of_100 * f.line_sd / wanted.line, in_95_of_100 * f.direction_sd / wanted.direction);
  f.time = f.acceleration * f.acceleration;
  f.enough = f.acceleration <= 1.0;
  return f;
}

}  // namespace

std::vector<JointForecast> forecast(const std::vector<FoundJoint>& joints, const WantedAccuracy& wanted) {
  std::vector<JointForecast> all;
  for (const FoundJoint& joint : joints)
    if (joint.type != FoundJointType::rigid) all.push_back(forecast(joint, wanted));
  return all;
}

bool enough_for_all(const std::vector<JointForecast>& joints) {
  return std::ranges::all_of(joints, &JointForecast::enough);
}

bool is_vague_azimuth(const JointForecast& joint, const WantedAccuracy& wanted) {
  return !joint.azimuth_of.empty() && in_95_of_100 * joint.azimuth_sd > wanted.direction;
}

bool a_drive_would_do(const JointForecast& joint) {
  constexpr double most = 10.0;  // times the acceleration: no machine has that to spare
  return joint.acceleration <= most;
}

std::string lacking_in_words(const std::vector<JointForecast>& joints) {
  std::vector<std::string> lacking;
  for (const JointForecast& f : joints)
    if (!f.enough)
      lacking.push_back(a_drive_would_do(f)
                            ? fmt::format("{} ({:.1f} times the acceleration, or {:.1f} times the time)", f.joint,
                                          f.acceleration, f.time)
                            : fmt::format("{} (± {:.0f} mm and ± {:.0f} mrad, more than a longer drive mends)", f.joint,
                                          1e3 * f.line_sd, 1e3 * f.direction_sd));
  return fmt::format("{}", fmt::join(lacking, ", "));
}

std::string azimuth_in_words(const JointForecast& joint) {
  return fmt::format(
      "the turn of {} about its only axis ({})", joint.azimuth_of,
      joint.azimuth_sd < unknowable ? fmt::format("± {:.0f} mrad", 1e3 * joint.azimuth_sd) : "not known");
}

std::string accuracy_in_words(const std::vector<JointForecast>& joints) {
  double line = 0.0, direction = 0.0;
  for (const JointForecast& f : joints)
    line = std::max(line, f.line_sd), direction = std::max(direction, f.direction_sd);
  return line > 0.0 ? fmt::format("± {:.1f} mm and ± {:.2f} mrad", 1e3 * line, 1e3 * direction) : "";
}

std::string in_words(const std::vector<JointForecast>& joints, const WantedAccuracy& wanted) {
  const std::string what = fmt::format("{:g} mm and {:g} mrad", 1e3 * wanted.line, 1e3 * wanted.direction);
  std::string text = enough_for_all(joints) ? fmt::format("enough for {} in every joint", what)
                                            : fmt::format("not enough for {} in {}", what, lacking_in_words(joints));
  std::vector<std::string> apart;
  if (std::ranges::any_of(joints, [](const JointForecast& f) { return !f.azimuth_of.empty(); }))
    apart.emplace_back("places that no signal tells");
  for (const JointForecast& f : joints)
    if (is_vague_azimuth(f, wanted)) apart.push_back(azimuth_in_words(f));
  return apart.empty() ? text : text + fmt::format(", but for {}", fmt::join(apart, " and "));
}

}  // namespace kinfer
