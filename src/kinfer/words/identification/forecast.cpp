// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/identification/forecast.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string insufficient_joint_text(const JointForecast& f) {
  if (!is_determined(f)) return fmt::format("{} (unknown)", f.joint);
  return f.more_excitation_suffices
             ? fmt::format("{} ({:.1f} times the acceleration, or {:.1f} times the time)", f.joint,
                           f.acceleration_factor, f.time_factor)
             : fmt::format("{} (± {:.0f} mm and ± {:.0f} mrad, which a longer recording does not improve enough)",
                           f.joint, 1e3 * f.line_sd, 1e3 * f.direction_sd);
}

/// ", except for ...": what the forecast does not include.
std::string exceptions_text(const std::vector<JointForecast>& joints) {
  std::vector<std::string> exceptions;
  if (std::ranges::any_of(joints, [](const JointForecast& f) { return !f.azimuth_of.empty(); }))
    exceptions.emplace_back("positions that are unobservable from this recording");
  for (const JointForecast& f : joints)
    if (f.azimuth_is_uncertain)
      exceptions.push_back(azimuth_text(f.azimuth_of, f.azimuth_sd, f.azimuth_is_unobservable));
  return exceptions.empty() ? "" : fmt::format(", except for {}", fmt::join(exceptions, " and "));
}

}  // namespace

std::string azimuth_text(const std::string& sensor, double sd, bool is_unobservable) {
  return phrase("azimuth_of_parent", "the azimuth of {} about its only axis ({})", sensor,
                is_unobservable ? "not known" : fmt::format("± {:.0f} mrad", 1e3 * sd));
}

std::string accuracy_text(const std::vector<JointForecast>& joints) {
  double line = 0.0, direction = 0.0;
  for (const JointForecast& f : joints)
    if (is_determined(f)) line = std::max(line, f.line_sd), direction = std::max(direction, f.direction_sd);
  return line > 0.0 ? fmt::format("± {:.1f} mm and ± {:.2f} mrad", 1e3 * line, 1e3 * direction) : "";
}

std::string forecast_text(const std::vector<JointForecast>& joints, const AccuracyTarget& target) {
  const std::string accuracy = fmt::format("{:g} mm and {:g} mrad", 1e3 * target.line, 1e3 * target.direction);
  if (all_sufficient(joints))
    return phrase("forecast_sufficient", "enough for {} in every joint{}", accuracy, exceptions_text(joints));
  constexpr std::size_t most = 4;
  std::vector<std::string> insufficient;
  std::size_t more = 0;
  for (const JointForecast& f : joints)
    if (!f.is_sufficient && insufficient.size() == most)
      ++more;
    else if (!f.is_sufficient)
      insufficient.push_back(insufficient_joint_text(f));
  if (more > 0) insufficient.push_back(fmt::format("and {} more", more));
  return phrase("forecast_insufficient", "not enough for {} in {}{}", accuracy, fmt::join(insufficient, ", "),
                exceptions_text(joints));
}

}  // namespace kinfer::words
