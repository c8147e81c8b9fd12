// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/synchronisation.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/screening/thresholds.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/inertial/sensor_clocks.hpp"
#include "kinfer/inertial/thresholds.hpp"
#include "kinfer/measurement/ins/ins_selection.hpp"

namespace kinfer::identify {
namespace {

/// Correction of a logger as a whole: the median over its sensors.
ClockCorrection logger_correction(const InsRecording& recording, const std::vector<ClockEstimate>& clocks,
                                  std::size_t logger) {
  std::vector<double> offsets, drifts;
  ClockCorrection logger_clock;
  for (std::size_t s = 0; s < clocks.size(); ++s) {
    if (!share_clock(recording, recording.sensors[s].logger, logger)) continue;
    logger_clock = clocks[s].correction;
    if (!clocks[s].known) continue;
    offsets.push_back(clocks[s].correction.offset);
    drifts.push_back(clocks[s].correction.drift);
  }
  if (!offsets.empty()) logger_clock.offset = median(offsets), logger_clock.drift = median(drifts);
  return logger_clock;
}

/// Of the first logger, to which the others are aligned. A drift that the other clocks disagree with is its own.
ClockCorrection reference_correction(const InsRecording& recording, const std::vector<ClockEstimate>& clocks) {
  ClockCorrection first = logger_correction(recording, clocks, 0);
  if (std::abs(first.drift) > inertial::odd_clock_drift) first.drift = 0.0;
  return first;
}

/// One correction per sensor, the same for all sensors of a logger and zero for the first logger, unless it is the odd
/// one.
std::vector<ClockCorrection> logger_corrections(const InsRecording& recording,
                                                const std::vector<ClockEstimate>& clocks) {
  std::vector<ClockCorrection> loggers;
  for (std::size_t l = 0; l < recording.loggers.size(); ++l) loggers.push_back(logger_correction(recording, clocks, l));
  const ClockCorrection first = reference_correction(recording, clocks);
  for (ClockCorrection& logger : loggers) logger.offset -= first.offset, logger.drift -= first.drift;
  std::vector<ClockCorrection> corrections;
  for (const InsSensor& sensor : recording.sensors) corrections.push_back(loggers[sensor.logger]);
  return corrections;
}

/// Sensors that differ from their logger by more than the usual scatter get their own correction.
std::vector<ClockCorrection> sensor_corrections(const InsRecording& recording, const std::vector<ClockEstimate>& clocks,
                                                const std::vector<ClockCorrection>& loggers) {
  const ClockCorrection first = reference_correction(recording, clocks);
  std::vector<ClockCorrection> corrections = loggers;
  for (std::size_t s = 0; s < clocks.size(); ++s) {
    if (!clocks[s].known) continue;
    ClockCorrection own = clocks[s].correction;
    own.offset -= first.offset;
    own.drift -= first.drift;
    const auto time = recording.time(recording.sensors[s]);
    const auto difference = [&](double t) { return std::abs(own.shift_at(t) - loggers[s].shift_at(t)); };
    if (std::max(difference(time.front()), difference(time.back())) > usual_offset_scatter) corrections[s] = own;
  }
  return corrections;
}

bool equal(const std::vector<ClockCorrection>& a, const std::vector<ClockCorrection>& b) {
  return std::ranges::equal(a, b, [](const ClockCorrection& x, const ClockCorrection& y) {
    return std::abs(x.offset - y.offset) <= 0.0 && std::abs(x.drift - y.drift) <= 0.0;
  });
}

/// Sum of the tree's distances [nats per row]; infinite if there is no tree.
double tree_length(const InsRecording& recording, const SegmentMotionOptions& options, int threads) {
  const auto ordered = order_segments(recording, options, {}, threads);
  if (!ordered) return std::numeric_limits<double>::infinity();
  double length = 0.0;
  for (std::size_t s = 0; s < ordered->tree.parent.size(); ++s)
    if (ordered->tree.parent[s]) length += ordered->tree.pair(s, *ordered->tree.parent[s]).distance;
  return length;
}

bool has_several_clocks(const InsRecording& recording) {
  for (std::size_t l = 1; l < recording.loggers.size(); ++l)
    if (!share_clock(recording, 0, l)) return true;
  return false;
}

bool all_zero(const std::vector<ClockCorrection>& corrections) {
  return std::ranges::all_of(corrections, &ClockCorrection::is_none);
}

}  // namespace

Synchronisation synchronise_sensors(const InsRecording& recording, const SegmentMotionOptions& options, int threads) {
  const auto synchronised_by = [&](const std::vector<ClockCorrection>& corrections) {
    return all_zero(corrections) ? std::nullopt : std::optional(synchronise_sensors(recording, corrections));
  };
  const ClockTreatment clock_treatment =
      has_several_clocks(recording) ? ClockTreatment::estimated : ClockTreatment::checked;
  if (recording.sensors.size() < 2)
    return {{}, std::vector<ClockCorrection>(recording.sensors.size()), clock_treatment};
  const auto clocks = estimate_sensor_clocks(recording, {}, threads);
  const auto loggers = logger_corrections(recording, clocks), own = sensor_corrections(recording, clocks, loggers);
  Synchronisation by_logger{synchronised_by(loggers), loggers, clock_treatment};
  if (equal(loggers, own)) return by_logger;
  Synchronisation by_sensor{synchronised_by(own), own, ClockTreatment::estimated};
  const double gain =
      tree_length(by_logger.of(recording), options, threads) - tree_length(by_sensor.of(recording), options, threads);
  return gain > min_own_clock_gain ? by_sensor : by_logger;
}

bool update_clocks(Synchronisation& clock, const InsRecording& recording, const std::vector<ResidualClock>& found) {
  if (found.empty()) return false;
  double largest = 0.0;
  for (std::size_t s = 0; s < found.size(); ++s) {
    const ClockCorrection &increment = found[s].correction, before = clock.corrections[s];
    const auto time = recording.time(recording.sensors[s]);
    for (const double t : {time.front(), time.back()})
      largest = std::max(largest, std::abs(increment.shift_at(t + before.shift_at(t))));
    clock.corrections[s].offset += increment.shift_at(before.middle + before.offset);
    clock.corrections[s].drift += increment.drift;
  }
  if (largest <= negligible_shift) return false;
  clock.synchronised = within(synchronise_sensors(recording, clock.corrections), clock.begin, clock.end);
  clock.clock_treatment = ClockTreatment::estimated;
  return true;
}

void restrict_to(Synchronisation& clock, const InsRecording& recording, const RecordingSelection& part) {
  clock.begin = std::max(clock.begin, part.begin);
  clock.end = std::min(clock.end, part.end);
  std::vector<ClockCorrection> kept;
  for (const std::size_t s : part.sensors) kept.push_back(clock.corrections[s]);
  clock.corrections = std::move(kept);
  clock.synchronised = within(select_sensors(clock.of(recording), part.sensors), clock.begin, clock.end);
}

Synchronisation relative_to_groups(Synchronisation clock, const InsRecording& recording,
                                   const std::vector<std::vector<std::size_t>>& groups) {
  if (has_several_clocks(recording) || groups.size() < 2) return clock;
  for (const auto& group : groups) {
    std::vector<double> offsets, drifts;
    for (const std::size_t s : group) {
      offsets.push_back(clock.corrections[s].offset);
      drifts.push_back(clock.corrections[s].drift);
    }
    const double offset = median(offsets), drift = median(drifts);
    for (const std::size_t s : group) clock.corrections[s].offset -= offset, clock.corrections[s].drift -= drift;
  }
  return clock;
}

ClockReport report_clocks(const Synchronisation& clock, const InsRecording& recording,
                          const std::vector<ResidualClock>& residual) {
  ClockReport report;
  if (residual.empty() && all_zero(clock.corrections)) return report;
  for (std::size_t s = 0; s < clock.corrections.size(); ++s) {
    const auto time = recording.time(recording.sensors[s]);
    const ClockCorrection& c = clock.corrections[s];
    const double middle = 0.5 * (time.front() + time.back());
    SensorClockEstimate evidence{.sensor = recording.sensors[s].name, .offset = c.shift_at(middle), .drift = c.drift};
    if (!residual.empty()) evidence.offset_sd = residual[s].offset_sd, evidence.drift_sd = residual[s].drift_sd;
    report.clocks.push_back(evidence);
    if (std::max(std::abs(c.shift_at(time.front())), std::abs(c.shift_at(time.back()))) < min_reported_shift) continue;
    report.findings.push_back({.kind = FindingKind::clock,
                               .severity = Severity::warning,
                               .values = {{"sensor", evidence.sensor},
                                          {"offset", evidence.offset},
                                          {"drift", evidence.drift},
                                          {"offset_sd", evidence.offset_sd},
                                          {"drift_sd", evidence.drift_sd}},
                               .applied = true});
  }
  return report;
}

}  // namespace kinfer::identify
