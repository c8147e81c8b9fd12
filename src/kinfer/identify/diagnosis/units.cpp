// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/identify/diagnosis/thresholds.hpp"
#include "kinfer/inertial/diagnosis/section_fit.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"
#include "kinfer/measurement/ins/unit_check.hpp"

namespace kinfer::identify {
namespace {

bool counts_rows(std::span<const double> time) {
  if (time.size() < 20) return false;
  std::size_t steps_of_one = 0;
  for (std::size_t k = 1; k < time.size(); ++k)
    if (std::abs(time[k] - time[k - 1] - 1.0) <= 0.0) ++steps_of_one;
  return 10 * steps_of_one > 9 * time.size() && std::abs(time[0] - std::round(time[0])) <= 0.0;
}

/// The sampling rate at which gyroscopes and accelerometers of a logger fit each other best; 1000 is that of a clock in
/// milliseconds. Only the turn from row to row counts, so rows 10 ms apart with scaled rates serve every hypothesis.
double best_rate(const InsRecording& recording, std::size_t logger, int threads) {
  constexpr std::array rates{1000.0, 10.0,  20.0,  25.0,  30.0,  40.0,  50.0,  60.0,  64.0,  75.0,  80.0,  100.0, 104.0,
                             120.0,  125.0, 128.0, 148.0, 150.0, 200.0, 208.0, 250.0, 256.0, 400.0, 500.0, 800.0};
  constexpr double assumed_rate = 100.0;
  std::vector<double> time = recording.loggers[logger].time;
  for (double& t : time) t /= assumed_rate;
  std::vector<SectionSignals> sensors;
  for (const InsSensor& sensor : recording.sensors)
    if (sensor.logger == logger)
      if (auto s = section_signals(sensor.acceleration, sensor.angular_velocity, time, max_quiet_rate / degree))
        sensors.push_back(std::move(*s));
  std::array<std::array<double, 2>, rates.size()> likelihood{};
  parallel_for(rates.size(), threads, [&](std::size_t r) {
    for (const SectionSignals& sensor : sensors)
      for (std::size_t u = 0; u < 2; ++u) {
        const auto maps = map_likelihoods(sensor, telling_sections(sensor),
                                          (u == 0 ? 1.0 : degree) * assumed_rate / rates[r], LeverArm::free);
        likelihood[r][u] += *std::ranges::max_element(maps.of);
      }
  });
  std::size_t best = 0;
  for (std::size_t r = 1; r < rates.size(); ++r)
    if (std::ranges::max(likelihood[r]) > std::ranges::max(likelihood[best])) best = r;
  return rates[best];
}

void set_unit(InsLogger& logger, double unit) {
  for (double& t : logger.time) t *= unit;
}

}  // namespace

void mend_clocks(MendedLog& log, int threads) {
  for (std::size_t l = 0; l < log.log().loggers.size(); ++l) {
    const InsLogger& logger = log.log().loggers[l];
    const double unit = clock_unit(logger).value_or(1.0);
    const std::string name = logger.name;
    if (!logger.states_unit && counts_rows(logger.time)) {
      const double rate = best_rate(log.log(), l, threads);
      set_unit(log.edit().loggers[l], 1.0 / rate);
      const bool is_ms = rate > 999.0;
      log.findings.push_back({.kind = is_ms ? FindingKind::clock_unit : FindingKind::clock_counts,
                              .severity = Severity::fault,
                              .values = {{"logger", name}, {"unit", 1.0 / rate}, {"rate", rate}},
                              .applied = is_ms});
    } else if (unit < 1.0) {
      set_unit(log.edit().loggers[l], unit);
      log.findings.push_back({.kind = FindingKind::clock_unit,
                              .severity = Severity::fault,
                              .values = {{"logger", name}, {"unit", unit}},
                              .applied = true});
    }
  }
}

Result<void> mend_forces(MendedLog& log) {
  for (std::size_t s = 0; s < log.log().sensors.size(); ++s) {
    const InsSensor& sensor = log.log().sensors[s];
    if (!sensor.acceleration.present()) continue;
    if (lacks_gravity(sensor) && !acceleration_unit(sensor))
      return error(
          "{0}: {0}_ax, {0}_ay, {0}_az hold no gravity: linear or free acceleration, which cannot be mended; "
          "export what the accelerometer measures",
          sensor.name);
    const double unit = acceleration_unit(sensor).value_or(1.0);
    if (std::abs(unit - 1.0) < 1e-9) continue;
    InsSensor& mended = log.edit().sensors[s];
    transform(mended.acceleration, unit, Mat3::Identity());
    flag_faults(mended);
    add_unit_finding(log, FindingKind::force_unit, Severity::fault, unit, mended.name);
  }
  return {};
}

void mend_fields(MendedLog& log) {
  for (std::size_t s = 0; s < log.log().sensors.size(); ++s) {
    const InsSensor& sensor = log.log().sensors[s];
    if (!sensor.has_magnetometer()) continue;
    const double unit = field_unit(sensor).value_or(1.0);
    if (std::abs(unit - 1.0) < 1e-9 || std::abs(unit - 100.0) < 1e-9) continue;  // gauss, or a field of about one unit
    InsSensor& mended = log.edit().sensors[s];
    transform(mended.field, unit, Mat3::Identity());
    flag_faults(mended);
    add_unit_finding(log, FindingKind::field_unit, Severity::warning, unit, mended.name);
  }
}

}  // namespace kinfer::identify
