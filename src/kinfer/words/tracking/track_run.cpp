// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/tracking/track_run.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string named(const std::vector<std::string>& names, int index, const char* kind) {
  return index >= 0 && static_cast<std::size_t>(index) < names.size() ? names[static_cast<std::size_t>(index)]
                                                                      : std::string(kind);
}

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& element : list) names.push_back(element.name);
  return names;
}

/// Faults that make the result useless, and those that do not.
bool is_fatal(TrackAlarmKind kind) {
  return kind == TrackAlarmKind::does_not_fit || kind == TrackAlarmKind::sensor_exchanged;
}

bool is_remark(TrackAlarmKind kind) {
  return kind == TrackAlarmKind::restarted || kind == TrackAlarmKind::sensor_clipped;
}

constexpr double any_angle = 30.0 * degree;

/// For most of the time the position could be any: beyond what a filter that linearises can follow.
bool is_lost(const TrackCurve& position) {
  const auto lost = std::ranges::count_if(position.sd, [](double sd) { return !(sd < any_angle); });
  return position.rotates && 2 * lost > static_cast<std::ptrdiff_t>(position.sd.size());
}

/// No angle of the machine is known; of prismatic joints alone acceleration and gravity tell little.
bool is_all_lost(const TrackRun& run) {
  const auto turns = [](const TrackCurve& position) { return position.rotates; };
  return std::ranges::any_of(run.positions, turns) &&
         std::ranges::all_of(run.positions,
                             [](const TrackCurve& position) { return !position.rotates || is_lost(position); });
}

/// After a gap such a position goes on from where it was, whatever the joint did meanwhile.
bool counts_from_start(const TrackRun& run) {
  return std::ranges::any_of(run.joints, [](const TrackJointShare& joint) { return joint.relative_to_start > 0.05; });
}

Usability usability_of(const TrackRun& run) {
  if (run.rows == 0 || is_all_lost(run)) return Usability::do_not_use;
  Usability worst = Usability::use;
  for (const TrackEvent& event : run.events) {
    if (is_fatal(event.alarm.kind) && std::isnan(event.until)) return Usability::do_not_use;
    if (!is_remark(event.alarm.kind) || (event.alarm.kind == TrackAlarmKind::restarted && counts_from_start(run)))
      worst = Usability::use_with_care;
  }
  const auto is_unknown = [](const TrackJointShare& joint) { return joint.unknown > 0.5; };
  return std::ranges::any_of(run.joints, is_unknown) || std::ranges::any_of(run.positions, is_lost)
             ? Usability::use_with_care
             : worst;
}

}  // namespace

std::vector<std::string> joint_sentences(const TrackRun& run) {
  std::vector<std::string> sentences;
  const auto list = [&](double TrackJointShare::*share) {
    constexpr double least_share = 0.05;  // of the rows; a start takes less
    std::vector<std::string> names;
    for (const TrackJointShare& joint : run.joints)
      if (joint.*share > least_share)
        names.push_back(joint.*share > 1.0 - least_share
                            ? joint.name
                            : phrase(joint.name, "{} ({:.0f} % of the time)", joint.name, 100.0 * (joint.*share)));
    return fmt::format("{}", fmt::join(names, ", "));
  };
  if (const std::string names = list(&TrackJointShare::unknown); !names.empty())
    sentences.push_back(phrase("position_unknown", "unknown: {}", names));
  if (const std::string names = list(&TrackJointShare::relative_to_start); !names.empty())
    sentences.push_back(
        phrase("relative_to_start", "relative to where tracking began, which --start can state: {}", names));
  if (const std::string names = list(&TrackJointShare::composed); !names.empty())
    sentences.push_back(phrase("composed", "from the orientations of two sensors alone: {}", names));
  return sentences;
}

namespace {

VerdictText verdict_of(const TrackRun& run, Usability usability) {
  const auto alarms = std::ranges::count_if(run.events, [](const TrackEvent& e) { return !is_remark(e.alarm.kind); });
  VerdictText text;
  text.recommendation = usability == Usability::use             ? phrase("use", "Use it")
                        : usability == Usability::use_with_care ? phrase("use_with_care", "Use it with care")
                                                                : phrase("do_not_use", "Do not use it");
  text.statement =
      usability == Usability::do_not_use && is_all_lost(run)
          ? phrase("nothing_known", "no joint position is known: its standard deviation is beyond {:.0f} deg",
                   any_angle / degree)
      : usability == Usability::do_not_use
          ? phrase("does_not_fit", "the log does not fit the chain")
          : phrase("tracked", "{} joint positions tracked over {:.1f} s, {} alarm{}", run.positions.size(),
                   run.end - run.begin, alarms == 0 ? "no" : fmt::to_string(alarms), alarms > 1 ? "s" : "");
  text.remarks = joint_sentences(run);
  return text;
}

}  // namespace

std::string sentence(const TrackAlarm& alarm, const std::vector<std::string>& sensors,
                     const std::vector<std::string>& joints) {
  const std::string_view id = name(alarm.kind);
  const std::string sensor = named(sensors, alarm.sensor, "a sensor"), joint = named(joints, alarm.joint, "a joint");
  switch (alarm.kind) {
    case TrackAlarmKind::does_not_fit:
      return phrase(id, "the log does not fit the chain: another machine, or axes that are permuted or mirrored");
    case TrackAlarmKind::sensor_moved:
      if (alarm.turn)
        return phrase(id,
                      "{} was turned by {:.2f} ± {:.2f} deg before the log began (± {:.2f} deg about the axis that the "
                      "motion shows least); its mounting is corrected",
                      sensor, alarm.turn->angle / degree, alarm.turn->sd / degree, alarm.turn->hidden_sd / degree);
      return phrase(id, "{} does not agree with the chain: turned, shifted, on another segment, or its biases changed",
                    sensor);
    case TrackAlarmKind::joint_changed:
      return phrase(id, "the joint {} does not agree with the chain: play, or bent", joint);
    case TrackAlarmKind::sensor_lost:
      return phrase(id, "{} sends no samples, or those of one instrument only", sensor);
    case TrackAlarmKind::sensor_stuck:
      return phrase(id, "{} repeats the same sample", sensor);
    case TrackAlarmKind::sensor_clipped:
      return phrase(id, "{} is at the end of its range", sensor);
    case TrackAlarmKind::sensor_late:
      return phrase(id, "the clock of {} disagrees with the others", sensor);
    case TrackAlarmKind::sensor_exchanged:
      return phrase(id, "{} measures in the place of another sensor: their cables, names or mountings are exchanged",
                    sensor);
    case TrackAlarmKind::start_wrong:
      return phrase(id, "gravity contradicts where --start places the joint {}, and is believed", joint);
    case TrackAlarmKind::restarted:
      break;
  }
  return phrase(name(TrackAlarmKind::restarted), "tracking started again after a gap");
}

TrackRun with_sentences(TrackRun run) {
  const std::vector<std::string> sensors = names_of(run.sensors), joints = names_of(run.joints);
  for (TrackEvent& event : run.events) event.sentence = sentence(event.alarm, sensors, joints);
  run.verdict.usability = usability_of(run);
  run.verdict.parts = verdict_of(run, run.verdict.usability);
  run.verdict.sentence = sentence(*run.verdict.parts);
  return run;
}

}  // namespace kinfer::words
