#include "kinfer/identify/one_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/ordered_motion.hpp"
#include "kinfer/inertial/sensor_clocks.hpp"
#include "kinfer/measurement/chosen_sensors.hpp"

namespace kinfer {
namespace {

constexpr double usual_spread = 6e-3;  // [s] of sensors on one clock, as rates tell it: each also moves by itself
constexpr double harmless = 1e-3;      // [s] for order and joint types
constexpr double worth_saying = 2e-4;  // [s]

/// The correction of a logger as a whole: the median of its sensors'.
ClockCorrection logger_correction(const InsRecording& recording, const std::vector<ClockEstimate>& clocks,
                                  std::size_t logger) {
  std::vector<double> offsets, drifts;
  ClockCorrection whole;
  for (std::size_t s = 0; s < clocks.size(); ++s) {
    if (recording.sensors[s].logger != logger) continue;
    whole = clocks[s].correction;
    if (!clocks[s].known) continue;
    offsets.push_back(clocks[s].correction.offset);
    drifts.push_back(clocks[s].correction.drift);
  }
  if (!offsets.empty()) whole.offset = median(offsets), whole.drift = median(drifts);
  return whole;
}

/// One correction a logger, the first logger's being none.
std::vector<ClockCorrection> of_loggers(const InsRecording& recording, const std::vector<ClockEstimate>& clocks) {
  std::vector<ClockCorrection> loggers;
  for (std::size_t l = 0; l < recording.loggers.size(); ++l) loggers.push_back(logger_correction(recording, clocks, l));
  const ClockCorrection first = loggers.front();
  for (ClockCorrection& logger : loggers) logger.offset -= first.offset, logger.drift -= first.drift;
  std::vector<ClockCorrection> corrections;
  for (const InsSensor& sensor : recording.sensors) corrections.push_back(loggers[sensor.logger]);
  return corrections;
}

/// Sensors that differ from their logger by more than is usual get their own correction.
std::vector<ClockCorrection> with_outliers(const InsRecording& recording, const std::vector<ClockEstimate>& clocks,
                                           const std::vector<ClockCorrection>& loggers) {
  const ClockCorrection first = logger_correction(recording, clocks, 0);
  std::vector<ClockCorrection> corrections = loggers;
  for (std::size_t s = 0; s < clocks.size(); ++s) {
    if (!clocks[s].known) continue;
    ClockCorrection own = clocks[s].correction;
    own.offset -= first.offset;
    own.drift -= first.drift;
    const auto time = recording.time(recording.sensors[s]);
    const auto apart = [&](double t) { return std::abs(own.shift_at(t) - loggers[s].shift_at(t)); };
    if (std::max(apart(time.front()), apart(time.back())) > usual_spread) corrections[s] = own;
  }
  return corrections;
}

bool equal(const std::vector<ClockCorrection>& a, const std::vector<ClockCorrection>& b) {
  return std::ranges::equal(a, b, [](const ClockCorrection& x, const ClockCorrection& y) {
    return std::abs(x.offset - y.offset) <= 0.0 && std::abs(x.drift - y.drift) <= 0.0;
  });
}

/// Sum of the tree's distances [nats a row]; infinite where there is no tree.
double tree_length(const InsRecording& recording, const SegmentMotionOptions& options, int threads) {
  const auto ordered = ordered_motion(recording, options, {}, threads);
  if (!ordered) return std::numeric_limits<double>::infinity();
  double length = 0.0;
  for (std::size_t s = 0; s < ordered->tree.parent.size(); ++s)
    if (ordered->tree.parent[s]) length += ordered->tree.pair(s, *ordered->tree.parent[s]).distance;
  return length;
}

std::string clock_in_words(const FoundClock& clock) {
  const auto sd = [](double value, double scale) {
    return value > 0.0 ? fmt::format(" (± {:.2f})", scale * value) : "";
  };
  std::string text =
      fmt::format("the readings of {} are logged {:.2f}{} ms {}", clock.sensor, 1e3 * std::abs(clock.offset),
                  sd(clock.offset_sd, 1e3), clock.offset < 0.0 ? "late" : "early");
  if (std::abs(clock.drift) > 4.0 * clock.drift_sd)
    text += fmt::format(", and its clock runs {:.1f}{} ppm {}", 1e6 * std::abs(clock.drift), sd(clock.drift_sd, 1e6),
                        clock.drift < 0.0 ? "fast" : "slow");
  return text;
}

bool none(const std::vector<ClockCorrection>& corrections) {
  return std::ranges::all_of(corrections, &ClockCorrection::is_none);
}

}  // namespace

OneClock on_one_clock(const InsRecording& recording, const SegmentMotionOptions& options, int threads) {
  const auto together = [&](const std::vector<ClockCorrection>& corrections) {
    return none(corrections) ? std::nullopt : std::optional(on_one_clock(recording, corrections));
  };
  const Clocks trust = recording.loggers.size() > 1 ? Clocks::estimated : Clocks::checked;
  if (recording.sensors.size() < 2) return {{}, std::vector<ClockCorrection>(recording.sensors.size()), trust};
  const auto clocks = sensor_clocks(recording, {}, threads);
  const auto loggers = of_loggers(recording, clocks), own = with_outliers(recording, clocks, loggers);
  OneClock by_logger{together(loggers), loggers, trust};
  if (equal(loggers, own)) return by_logger;
  constexpr double notable = 0.3;  // [nats a row]
  OneClock by_sensor{together(own), own, Clocks::estimated};
  const double gain =
      tree_length(by_logger.of(recording), options, threads) - tree_length(by_sensor.of(recording), options, threads);
  return gain > notable ? by_sensor : by_logger;
}

bool take_up(OneClock& clock, const InsRecording& recording, const std::vector<RefinedClock>& found) {
  if (found.empty()) return false;
  double largest = 0.0;
  for (std::size_t s = 0; s < found.size(); ++s) {
    const ClockCorrection &more = found[s].correction, before = clock.corrections[s];
    const auto time = recording.time(recording.sensors[s]);
    for (const double t : {time.front(), time.back()})
      largest = std::max(largest, std::abs(more.shift_at(t + before.shift_at(t))));
    clock.corrections[s].offset += more.shift_at(before.middle + before.offset);
    clock.corrections[s].drift += more.drift;
  }
  if (largest <= harmless) return false;
  clock.moved = within(on_one_clock(recording, clock.corrections), clock.begin, clock.end);
  clock.trust = Clocks::estimated;
  return true;
}

void narrow(OneClock& clock, const InsRecording& recording, const std::vector<std::size_t>& sensors, double begin,
            double end) {
  clock.begin = std::max(clock.begin, begin);
  clock.end = std::min(clock.end, end);
  std::vector<ClockCorrection> kept;
  for (const std::size_t s : sensors) kept.push_back(clock.corrections[s]);
  clock.corrections = std::move(kept);
  clock.moved = within(with_sensors(clock.of(recording), sensors), clock.begin, clock.end);
}

void say_clocks(Identification& result, const OneClock& clock, const InsRecording& recording,
                const std::vector<RefinedClock>& found) {
  if (found.empty() && none(clock.corrections)) return;
  for (std::size_t s = 0; s < clock.corrections.size(); ++s) {
    const auto time = recording.time(recording.sensors[s]);
    const ClockCorrection& c = clock.corrections[s];
    const double middle = 0.5 * (time.front() + time.back());
    FoundClock evidence{.sensor = recording.sensors[s].name, .offset = c.shift_at(middle), .drift = c.drift};
    if (!found.empty()) evidence.offset_sd = found[s].offset_sd, evidence.drift_sd = found[s].drift_sd;
    result.clocks.push_back(evidence);
    if (std::max(std::abs(c.shift_at(time.front())), std::abs(c.shift_at(time.back()))) < worth_saying) continue;
    result.findings.push_back({.kind = "clock",
                               .severity = Severity::warning,
                               .sentence = clock_in_words(evidence),
                               .suggestion = "put all sensors on one clock, or let their loggers synchronise",
                               .applied = true});
  }
}

}  // namespace kinfer
