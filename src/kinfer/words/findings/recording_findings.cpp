// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/findings/recording_findings.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/expect.hpp"
#include "kinfer/words/findings/finding_words.hpp"
#include "kinfer/words/findings/log_findings.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string given_link_sentence(const Finding& f) {
  const FactValues& v = f.values;
  if (f.severity == Severity::note)
    return phrase("given_link_fits", "the given link {} fits about as well as {}, which the log alone would choose",
                  v.text("link"), v.text("replaced_link"));
  return phrase("given_link_contradicted",
                "the given link {} is against the log: a joint there leaves {:.3f} m/s² and {:.4f} rad/s unexplained, "
                "{} leaves {:.3f} m/s² and {:.4f} rad/s ({:.2g} times less a row)",
                v.text("link"), v.number("residual"), v.number("off_axis_rate"), v.text("replaced_link"),
                v.number("replaced_residual"), v.number("replaced_off_axis_rate"), v.number("ratio"));
}

std::string given_link_suggestion(const Finding& f) {
  if (f.severity == Severity::note) return "";
  return phrase("given_link_contradicted.suggestion", "leave out --tree, or check which sensor sits on which segment");
}

std::string loop_sentence(const Finding& f) {
  const FactValues& v = f.values;
  return phrase("loop",
                "the segments {} close a loop: {} and {} share a revolute joint, too (a fit that leaves it open keeps "
                "its two halves within {:.1f} mm of each other, the same movements with one joint mirrored part "
                "them by {:.0f} mm); "
                "the joint is part of the fit, and a closure of the chain",
                fmt::join(v.texts("segments"), ", "), v.text("first"), v.text("second"), 1e3 * v.number("gap"),
                1e3 * v.number("mirrored_gap"));
}

std::string loop_suggestion(const Finding&) {
  return "";  // nothing is wrong with the recording
}

std::string best_link_text(const FactValues& v) {
  return fmt::format("the best link, {}, leaves {:.3f} m/s² where joints leave {:.3f}", v.text("link"),
                     v.number("residual"), v.number("usual_residual"));
}

std::string several_machines_sentence(const Finding& f) {
  const FactValues& v = f.values;
  if (f.applied && v.has("connection_gain"))
    return phrase("separate_part",
                  "{} share no joint with the others that a type of joint describes ({}), though they move with them: "
                  "part of the machine beyond a joint that gives way, or beyond a segment without INS; they are left "
                  "out",
                  fmt::join(v.texts("sensors"), ", "), best_link_text(v));
  if (f.applied)
    return phrase("separate_machine",
                  "{} share no joint with the others ({}): a separate machine, or a segment without INS between; they "
                  "are left out",
                  fmt::join(v.texts("sensors"), ", "), best_link_text(v));
  return phrase("machines_on_one_ground",
                "the sensors that move fall into {} groups that share only the ground ({}): several machines in one "
                "log; the chain contains all of them, their relative position is unobservable",
                v.texts("groups").size(), fmt::join(v.texts("groups"), "; "));
}

std::string several_machines_suggestion(const Finding& f) {
  if (f.applied)
    return phrase("separate_machine.suggestion", "identify them by themselves with --sensors {}",
                  fmt::join(f.values.texts("sensors"), ","));
  return phrase("machines_on_one_ground.suggestion", "identify one by itself with --sensors");
}

std::string linkage_sentence(const Finding& f) {
  return phrase("linkage",
                "{} shares no joint with any other sensor ({}): it rotates about one axis but around no fixed point, "
                "as the bar of a linkage (a loop) does, or a segment without INS lies between; it is left out",
                f.values.text("sensor"), best_link_text(f.values));
}

std::string no_joint_sentence(const Finding& f) {
  return phrase("no_joint",
                "{} shares no joint with any other sensor ({}): a loose sensor, another machine's, or a segment "
                "without INS between; it is left out",
                f.values.text("sensor"), best_link_text(f.values));
}

std::string no_joint_suggestion(const Finding&) {
  return phrase("no_joint.suggestion", "mount an INS on every segment, and none on the bars of a linkage");
}

std::string fragmented_sensor_sentence(const Finding& f) {
  const FactValues& v = f.values;
  return phrase("fragmented_sensor",
                "{} measures in {} pieces of {:.1f} s: behind each gap its orientation is another one, and so short a "
                "piece does not tell it; left out: {}",
                v.text("sensor"), v.count("pieces"), v.number("piece"), fmt::join(v.texts("left_out"), ", "));
}

std::string fragmented_sensor_suggestion(const Finding& f) {
  return phrase("fragmented_sensor.suggestion", "mend the radio or cable of {}, and record again",
                f.values.text("sensor"));
}

std::string not_connected_sentence(const Finding& f) {
  return phrase("not_connected",
                "{} has nothing to do with the other sensors: a joint explains its motion no better than it explains "
                "that of a recording shifted in time; it is left out",
                f.values.text("sensor"));
}

std::string not_connected_suggestion(const Finding&) {
  return phrase("not_connected.suggestion",
                "check that all sensors were on one machine and recorded at the same time, and their units and clocks");
}

std::string other_machine_sentence(const Finding& f) {
  return phrase("other_machine",
                "{} changes are needed to bring the older chain to this log, on a machine of {} sensors: the log is "
                "of another machine, or all of it was mounted anew",
                f.values.count("changes"), f.values.count("sensors"));
}

std::string other_machine_suggestion(const Finding&) {
  return phrase("other_machine.suggestion", "identify this log by itself, without --update");
}

std::string mixed_recording_sentence(const Finding& f) {
  return phrase(
      "mixed_recording",
      "{} shares joints with the others from {:.0f} to {:.0f} s that it does not share in the rest: recordings "
      "were mixed, sensors were exchanged, or it came off its segment",
      f.values.text("sensor"), f.values.number("begin"), f.values.number("end"));
}

std::string mixed_recording_suggestion(const Finding&) {
  return phrase("mixed_recording.suggestion", "check from which files the log was put together, or record again");
}

std::string duplicate_sensor_sentence(const Finding& f) {
  return phrase("duplicate_sensor", "{} and {} hold the same measurements: one sensor under two names",
                f.values.text("first"), f.values.text("second"));
}

std::string duplicate_sensor_suggestion(const Finding&) {
  return phrase("duplicate_sensor.suggestion", "find the measurements of the sensor whose place the copy took");
}

std::string idle_sentence(const Finding& f) {
  const FactValues& v = f.values;
  return phrase("idle",
                "the sensors {} never move: joints that nobody moved, several INS on one base, or the bases of several "
                "machines; {} left out, and {} stands for the ground",
                fmt::join(v.texts("stationary"), ", "), fmt::join(v.texts("left_out"), ", "), v.text("kept"));
}

std::string idle_suggestion(const Finding&) {
  return phrase("idle.suggestion", "move every joint, and give each machine a log of its own");
}

std::string remounted_sentence(const Finding& f) {
  const FactValues& v = f.values;
  return phrase("remounted",
                "the mounting of {} changed between {:.1f} and {:.1f} s: a joint's axis turned by {:.1f} deg in it and "
                "the joint's point moved by about {:.0f} mm; only what was recorded {} is used",
                v.text("sensor"), v.number("begin"), v.number("end"), Angle::rad(v.number("axis_rotation")).deg(),
                1e3 * v.number("point_shift"), v.text("used_part"));
}

std::string remounted_suggestion(const Finding&) {
  return phrase("remounted.suggestion", "fix the sensor and record again, or give each part a log of its own");
}

std::string clock_sentence(const Finding& f) {
  constexpr double certain = 4.0;  // standard deviations beyond which a drift is stated
  const FactValues& v = f.values;
  const auto sd = [](double value, double scale) {
    return value > 0.0 ? fmt::format(" (± {:.2f})", scale * value) : "";
  };
  const double offset = v.number("offset"), drift = v.number("drift"), drift_sd = v.number("drift_sd");
  const std::string drift_text = std::abs(drift) > certain * drift_sd
                                     ? fmt::format(", and its clock runs {:.1f}{} ppm {}", 1e6 * std::abs(drift),
                                                   sd(drift_sd, 1e6), drift < 0.0 ? "fast" : "slow")
                                     : "";
  return phrase("clock", "the measurements of {} are logged {:.2f}{} ms {}{}", v.text("sensor"), 1e3 * std::abs(offset),
                sd(v.number("offset_sd"), 1e3), offset < 0.0 ? "late" : "early", drift_text);
}

std::string clock_suggestion(const Finding&) {
  return phrase("clock.suggestion", "put all sensors on one clock, or let their loggers synchronise");
}

std::string timestamp_jitter_sentence(const Finding& f) {
  const FactValues& v = f.values;
  const auto sensors = v.texts("sensors");
  const double scatter = 1e3 * v.number("jitter"), rate = 1.0 / v.number("period");
  if (const double rows = v.number("rows_per_packet"); rows > 1.0)
    return phrase("timestamp_packets",
                  "{} sampled every {:.3f} ms ({:.1f} Hz), but the log stamps about {:.0f} rows at once, {:.2f} ms rms "
                  "off; the regular times are used, at which the signals are smooth",
                  fmt::join(sensors, ", "), 1e3 * v.number("period"), rate, rows, scatter);
  return phrase(
      "timestamp_jitter",
      "{} sampled every {:.3f} ms ({:.1f} Hz), but the log's time stamps scatter about that by {:.2f} ms rms; "
      "the regular times are used, at which the signals are smooth",
      fmt::join(sensors, ", "), 1e3 * v.number("period"), rate, scatter);
}

std::string timestamp_jitter_suggestion(const Finding&) {
  return phrase("timestamp_jitter.suggestion", "log the sensors' own sample times instead of the times of arrival");
}

/// "reads 2.00 ± 0.10 % too much"
std::string reading(const FactValues& v) {
  return fmt::format("{:.2f} ± {:.2f} % too {}", 100.0 * std::abs(v.number("scale")), 100.0 * v.number("sd"),
                     v.number("scale") > 0.0 ? "much" : "little");
}

std::string instrument_scale_sentence(const Finding& f) {
  const FactValues& v = f.values;
  const std::string& part = v.text("part");
  if (part == "axes")
    return phrase("instrument_axes_skewed",
                  "the axes of the {} of {} are off by {:.2f} deg, more than its grade says; they were estimated",
                  v.text("instrument"), v.text("sensor"), Angle::rad(v.number("scale")).deg());
  if (part == "turned")
    return phrase(
        "instrument_axes_turned",
        "gyroscope and accelerometer of {} are turned by {:.2f} deg against each other, more than their grade "
        "says; which of them is along the housing is unknown, and axes and points in it are so uncertain",
        v.text("sensor"), Angle::rad(v.number("scale")).deg());
  const std::string along = part == "all" ? "" : fmt::format(" along its {} axis", part);
  return phrase("instrument_scale",
                "the {} of {} reads {}{}, more than its grade says; this was estimated and corrected",
                v.text("instrument"), v.text("sensor"), reading(v), along);
}

std::string instrument_scale_suggestion(const Finding&) {
  return phrase("instrument_scale.suggestion", "have the sensor calibrated, or state what it is worth with --grade");
}

std::string clock_rate_sentence(const Finding& f) {
  const double scale = f.values.number("scale");
  return phrase(
      "clock_rate",
      "all gyroscopes read {} beside the turns that gravity shows: either they do, which the fit assumes, or the "
      "clock runs {:.2f} % {}, and then every length is {:.2f} times as long",
      reading(f.values), 100.0 * std::abs(scale), scale > 0.0 ? "fast" : "slow", 1.0 / ((1.0 + scale) * (1.0 + scale)));
}

std::string clock_rate_suggestion(const Finding&) {
  return phrase("clock_rate.suggestion",
                "check the sampling rate and the unit of the rates, or measure one length and compare");
}

constexpr std::array recording_finding_words{
    FindingWords{FindingKind::instrument_scale, instrument_scale_sentence, instrument_scale_suggestion},
    FindingWords{FindingKind::clock_rate, clock_rate_sentence, clock_rate_suggestion},
    FindingWords{FindingKind::given_link, given_link_sentence, given_link_suggestion},
    FindingWords{FindingKind::loop, loop_sentence, loop_suggestion},
    FindingWords{FindingKind::several_machines, several_machines_sentence, several_machines_suggestion},
    FindingWords{FindingKind::linkage, linkage_sentence, no_joint_suggestion},
    FindingWords{FindingKind::no_joint, no_joint_sentence, no_joint_suggestion},
    FindingWords{FindingKind::fragmented_sensor, fragmented_sensor_sentence, fragmented_sensor_suggestion},
    FindingWords{FindingKind::not_connected, not_connected_sentence, not_connected_suggestion},
    FindingWords{FindingKind::other_machine, other_machine_sentence, other_machine_suggestion},
    FindingWords{FindingKind::mixed_recording, mixed_recording_sentence, mixed_recording_suggestion},
    FindingWords{FindingKind::duplicate_sensor, duplicate_sensor_sentence, duplicate_sensor_suggestion},
    FindingWords{FindingKind::idle, idle_sentence, idle_suggestion},
    FindingWords{FindingKind::remounted, remounted_sentence, remounted_suggestion},
    FindingWords{FindingKind::clock, clock_sentence, clock_suggestion},
    FindingWords{FindingKind::timestamp_jitter, timestamp_jitter_sentence, timestamp_jitter_suggestion},
};

const FindingWords* find_words(std::span<const FindingWords> table, FindingKind kind) {
  const auto row = std::ranges::find(table, kind, &FindingWords::kind);
  return row == table.end() ? nullptr : &*row;
}

const FindingWords* recording_words(FindingKind kind) {
  const FindingWords* words = find_words(recording_finding_words, kind);
  return words ? words : find_words(log_words(), kind);
}

const FindingWords& recording_words_of(FindingKind kind) {
  const FindingWords* words = recording_words(kind);
  KINFER_EXPECT(words, "\"{}\" is not about a recording", name(kind));
  return *words;
}

}  // namespace

bool is_recording_finding(FindingKind kind) {
  return recording_words(kind) != nullptr;
}

std::string recording_finding_sentence(const Finding& finding) {
  return recording_words_of(finding.kind).sentence(finding);
}

std::string recording_finding_suggestion(const Finding& finding) {
  return recording_words_of(finding.kind).suggestion(finding);
}

}  // namespace kinfer::words
