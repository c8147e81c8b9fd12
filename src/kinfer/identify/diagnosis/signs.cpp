// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/signs.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/diagnosis/axes.hpp"
#include "kinfer/identify/diagnosis/neighbours.hpp"
#include "kinfer/identify/diagnosis/thresholds.hpp"
#include "kinfer/inertial/diagnosis/vertical_rates.hpp"

namespace kinfer::identify {
namespace {

/// [rad] Median angle between specific force and field while the sensor rotates slowly; empty without magnetometer.
std::optional<double> field_angle(const InsSensor& sensor) {
  constexpr double slow_rate = 0.5;  // [rad/s]
  constexpr std::size_t least_rows = 20, most_rows = 20000;
  if (!sensor.has_magnetometer()) return std::nullopt;
  std::vector<double> angles;
  const std::size_t stride = 1 + sensor.rows() / most_rows;
  for (std::size_t row = 0; row < sensor.rows(); row += stride) {
    const Vec3 f = sensor.acceleration.at(row), m = sensor.field.at(row), w = sensor.angular_velocity.at(row);
    if (f.allFinite() && m.allFinite() && w.norm() < slow_rate && f.norm() > 0.0 && m.norm() > 0.0)
      angles.push_back(angle_between(f, m));
  }
  if (angles.size() < least_rows) return std::nullopt;
  return median(std::move(angles));
}

/// +1 or −1 of each sensor's vertical against that of the group which it is linked to; 0: linked to none.
struct VerticalSigns {
  std::vector<int> sign;
  bool is_tied = false;  ///< as many sensors one way as the other
};

VerticalSigns vertical_signs(const std::vector<std::vector<VerticalAgreement>>& agreement) {
  const std::size_t n = agreement.size();
  VerticalSigns result{std::vector<int>(n, 0)};
  for (std::size_t start = 0; start < n; ++start) {
    if (result.sign[start] != 0) continue;
    std::vector<std::size_t> group{start};
    result.sign[start] = 1;
    for (std::size_t i = 0; i < group.size(); ++i)
      for (std::size_t j = 0; j < n; ++j) {
        const VerticalAgreement& a = agreement[group[i]][j];
        if (result.sign[j] != 0 || std::abs(a.correlation) < same_vertical || a.shared_rate < min_vertical_rate)
          continue;
        result.sign[j] = a.correlation > 0.0 ? result.sign[group[i]] : -result.sign[group[i]];
        group.push_back(j);
      }
    int sum = 0;
    for (const std::size_t s : group) sum += result.sign[s];
    if (group.size() == 1) result.sign[start] = 0;
    if (sum < 0)
      for (const std::size_t s : group) result.sign[s] = -result.sign[s];
    if (sum == 0 && group.size() > 1) result.is_tied = true;
  }
  return result;
}

void turn_over(InsSensor& sensor, bool field_too) {
  transform(sensor.acceleration, -1.0, Mat3::Identity());
  if (field_too) transform(sensor.field, -1.0, Mat3::Identity());
}

Finding* axes_finding_of(MendedLog& log, const std::string& sensor) {
  const auto at = std::ranges::find_if(log.findings, [&](const Finding& f) {
    return (f.kind == FindingKind::rate_sign || f.kind == FindingKind::instrument_axes) &&
           f.values.text("sensor") == sensor;
  });
  return at == log.findings.end() ? nullptr : &*at;
}

/// What a negated specific force means, given what the axes of the sensor were.
void report_turned(MendedLog& log, const std::string& sensor, double gain) {
  Finding* axes = axes_finding_of(log, sensor);
  if (axes && axes->kind == FindingKind::rate_sign) {
    axes->kind = FindingKind::left_handed;
    axes->applied = true;
    axes->equivalents.clear();
    return;
  }
  log.findings.push_back({.kind = FindingKind::force_sign,
                          .severity = Severity::fault,
                          .values = {{"sensors", std::vector<std::string>{sensor}}, {"log_likelihood_gain", gain}},
                          .applied = true});
}

/// A gyroscope that says the opposite of its neighbours, where its own accelerometer says nothing of its sense.
void reverse_gyroscope(MendedLog& log, std::size_t s, double gain) {
  InsSensor& sensor = log.edit().sensors[s];
  transform(sensor.angular_velocity, -1.0, Mat3::Identity());
  log.findings.push_back({.kind = FindingKind::rate_sign,
                          .severity = Severity::fault,
                          .values = {{"sensor", sensor.name},
                                     {"instrument", std::string("gyroscope")},
                                     {"axes", describe_axes(-Mat3::Identity())},
                                     {"log_likelihood_gain", gain}},
                          .applied = true});
}

bool has_reversed_gyroscopes(const MendedLog& log) {
  return std::ranges::find(log.findings, FindingKind::rate_sign, &Finding::kind) != log.findings.end();
}

/// Turns over what is opposite to its neighbours, if the segment tree agrees. For a sensor that hardly tilts a reversed
/// gyroscope looks much the same: what others of the log have is the likelier fault.
void mend_odd_sensors(MendedLog& log, const std::vector<std::optional<double>>& angles, const VerticalSigns& signs,
                      int threads) {
  const std::size_t n = log.log().sensors.size();
  const bool some_down = std::ranges::any_of(angles, [](auto& a) { return a && *a > downward_field; });
  std::vector<std::size_t> odd;
  for (std::size_t s = 0; s < n; ++s) {
    const bool is_up = angles[s] && *angles[s] < upward_field;
    const bool is_opposite = signs.sign[s] < 0 && !signs.is_tied;
    if (is_opposite || (is_up && some_down)) odd.push_back(s);
  }
  if (odd.empty() || odd.size() == n) return;
  double length = tree_length(log.log(), threads);
  for (const std::size_t s : odd) {
    const bool field_too = angles[s] && *angles[s] > downward_field;
    InsRecording turned = log.log();
    turn_over(turned.sensors[s], field_too);
    const double turned_length = tree_length(turned, threads);
    const bool by_field = !field_too && angles[s] && *angles[s] < upward_field && some_down;
    const double gain = length - turned_length;
    if (!by_field && !axes_finding_of(log, log.log().sensors[s].name) && has_reversed_gyroscopes(log)) {
      InsRecording reversed = log.log();
      transform(reversed.sensors[s].angular_velocity, -1.0, Mat3::Identity());
      if (const double found = tree_length(reversed, threads);
          length - found > min_sign_gain && found < turned_length + likely_sign_lead) {
        reverse_gyroscope(log, s, length - found);
        length = found;
        continue;
      }
    }
    if (!(gain > min_sign_gain) && !(by_field && gain > -min_sign_gain)) continue;
    length = turned_length;
    turn_over(log.edit().sensors[s], field_too);
    report_turned(log, log.log().sensors[s].name, gain);
  }
}

void report_common_sign(MendedLog& log) {
  std::vector<std::string> up;
  bool some_down = false;
  for (const InsSensor& sensor : log.log().sensors)
    if (const auto angle = field_angle(sensor)) {
      some_down |= *angle > downward_field;
      if (*angle < upward_field) up.push_back(sensor.name);
    }
  if (up.empty() || some_down) return;
  log.findings.push_back({.kind = FindingKind::force_sign, .severity = Severity::warning, .values = {{"sensors", up}}});
}

/// A reversed gyroscope without neighbours that tell its vertical may as well be a left-handed sensor.
void report_equivalents(MendedLog& log, const VerticalSigns& signs) {
  const std::size_t n = log.log().sensors.size();
  const auto is_reversed = [&](std::size_t s) {
    const Finding* f = axes_finding_of(log, log.log().sensors[s].name);
    return f && f->kind == FindingKind::rate_sign;
  };
  std::vector<std::size_t> reversed;
  bool has_sound_neighbour = false;
  for (std::size_t s = 0; s < n; ++s)
    if (is_reversed(s))
      reversed.push_back(s);
    else if (signs.sign[s] != 0)
      has_sound_neighbour = true;
  for (const std::size_t s : reversed) {
    if (has_sound_neighbour && signs.sign[s] != 0 && !signs.is_tied) continue;
    Finding* f = axes_finding_of(log, log.log().sensors[s].name);
    f->applied = false;
    f->equivalents = {{.kind = FindingKind::left_handed, .severity = Severity::fault, .values = f->values}};
  }
}

void report_tie(MendedLog& log, const VerticalSigns& signs) {
  std::vector<std::string> one, other;
  for (std::size_t s = 0; s < signs.sign.size(); ++s)
    if (signs.sign[s] != 0) (signs.sign[s] > 0 ? one : other).push_back(log.log().sensors[s].name);
  log.findings.push_back({.kind = FindingKind::opposite_verticals,
                          .severity = Severity::fault,
                          .values = {{"sensors", one}, {"others", other}}});
}

}  // namespace

void mend_signs(MendedLog& log, int threads) {
  const auto agreement = vertical_agreement(log.log());
  const VerticalSigns signs = vertical_signs(agreement);
  std::vector<std::optional<double>> angles;
  for (const InsSensor& sensor : log.log().sensors) angles.push_back(field_angle(sensor));
  mend_odd_sensors(log, angles, signs, threads);
  if (signs.is_tied)
    if (const VerticalSigns after = vertical_signs(vertical_agreement(log.log())); after.is_tied)
      report_tie(log, after);
  report_equivalents(log, signs);
  report_common_sign(log);
}

}  // namespace kinfer::identify
