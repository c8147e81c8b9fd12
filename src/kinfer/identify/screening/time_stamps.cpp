// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/time_stamps.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/inertial/sampling_grid.hpp"
#include "kinfer/inertial/thresholds.hpp"
#include "kinfer/measurement/ins/interleaved_sensors.hpp"

namespace kinfer::identify {
namespace {

struct RegularTimes {
  SamplingGrid grid;
  double scatter = 0.0;  // [s] of the stamps about them
  TimeEvidence evidence;
};

/// Evidence of all sensors of a logger.
TimeEvidence logger_evidence(const InsRecording& recording, std::size_t logger, std::span<const double> other,
                             std::size_t stride) {
  TimeEvidence sum;
  for (const InsSensor& sensor : recording.sensors)
    if (sensor.logger == logger) sum.add(compare_times(sensor, recording.time(sensor), other, stride));
  return sum;
}

/// The better one of the grids that fit the stamps of a logger; empty where the stamps are regular or better.
std::optional<RegularTimes> regular_times(const InsRecording& recording, std::size_t logger) {
  const std::vector<double>& stamps = recording.loggers[logger].time;
  std::optional<RegularTimes> best;
  for (const LostSamples lost : {LostSamples::anywhere, LostSamples::in_gaps_only}) {
    auto grid = fit_sampling_grid(stamps, lost);
    if (!grid) continue;
    const double scatter = time_scatter(stamps, grid->time);
    if (scatter < std::max(inertial::min_time_scatter, inertial::min_time_scatter_share * grid->period)) continue;
    const TimeEvidence evidence = logger_evidence(recording, logger, grid->time, window_stride(scatter, grid->period));
    if (evidence.favours_other() && (!best || evidence.gain > best->evidence.gain))
      best = RegularTimes{std::move(*grid), scatter, evidence};
  }
  return best;
}

/// Rows that were stamped at once: 1 where most steps between stamps are about a period long.
double rows_per_packet(std::span<const double> stamps, double period) {
  constexpr double at_once = 0.2;  // of a period
  std::size_t packets = 1;
  for (std::size_t k = 1; k < stamps.size(); ++k)
    if (stamps[k] - stamps[k - 1] > at_once * period) ++packets;
  const double rows = static_cast<double>(stamps.size()) / static_cast<double>(packets);
  return rows > 1.8 ? rows : 1.0;  // fewer are rows that jitter brought together
}

Finding jitter_finding(const InsRecording& recording, std::size_t logger, const RegularTimes& times) {
  std::vector<std::string> sensors;
  for (const InsSensor& sensor : recording.sensors)
    if (sensor.logger == logger) sensors.push_back(sensor.name);
  return {.kind = FindingKind::timestamp_jitter,
          .severity = Severity::warning,
          .values = {{"sensors", sensors},
                     {"jitter", times.scatter},
                     {"period", times.grid.period},
                     {"rows_per_packet", rows_per_packet(recording.loggers[logger].time, times.grid.period)},
                     {"log_likelihood_gain", times.evidence.gain}},
          .applied = true};
}

}  // namespace

MendedTimeStamps mend_time_stamps(const InsRecording& recording, int threads) {
  MendedTimeStamps result{separate_interleaved_sensors(recording), {}};
  const InsRecording& separate = result.recording ? *result.recording : recording;
  std::vector<std::optional<RegularTimes>> times(separate.loggers.size());
  parallel_for(times.size(), threads, [&](std::size_t l) { times[l] = regular_times(separate, l); });
  for (std::size_t l = 0; l < times.size(); ++l)
    if (times[l]) result.findings.push_back(jitter_finding(separate, l, *times[l]));
  if (result.findings.empty()) return result;
  if (!result.recording) result.recording = recording;
  for (std::size_t l = 0; l < times.size(); ++l)
    if (times[l]) result.recording->loggers[l].time = std::move(times[l]->grid.time);
  return result;
}

}  // namespace kinfer::identify
