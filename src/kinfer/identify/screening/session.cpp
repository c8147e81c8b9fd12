// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/session.hpp"

#include <algorithm>
#include <iterator>

#include "kinfer/identify/screening/duplicates.hpp"
#include "kinfer/identify/screening/machines.hpp"
#include "kinfer/identify/screening/remount.hpp"
#include "kinfer/identify/screening/time_stamps.hpp"
#include "kinfer/identify/screening/unconnected.hpp"
#include "kinfer/measurement/ins/ins_selection.hpp"

namespace kinfer::identify {
namespace {

constexpr double max_sampling_period = 0.09;  // [s] steps of 0.1 s are gaps (inertial/thresholds)
constexpr int advised_sampling_rate = 50;     // [Hz]
constexpr int max_clock_updates = 3;          // the third is applied and reported, but not fitted again
constexpr int max_restrictions = 6;           // each removes a machine or one side of a remounting

Result<RecordingSelection> select_moving_sensors(const InsRecording& recording, const std::vector<std::string>& names,
                                                 const std::optional<std::string>& root,
                                                 const SegmentMotionOptions& motion) {
  if (names.empty()) return exclude_idle_sensors(recording, motion, root);
  KINFER_TRY(named, find_sensors(recording, names));
  RecordingSelection chosen = exclude_idle_sensors(select_sensors(recording, named), motion, root);
  for (std::size_t& s : chosen.sensors) s = named[s];
  return chosen;
}

}  // namespace

Result<Session> Session::open(const InsRecording& recording, const std::vector<std::string>& sensors,
                              const std::optional<std::string>& root, const SegmentMotionOptions& motion, int threads) {
  for (const InsSensor& sensor : recording.sensors)
    if (!sensor.acceleration.present() || !sensor.angular_velocity.present())
      return error("{}: identification needs specific force (ax ay az) and angular rate (gx gy gz)", sensor.name);
  for (const InsLogger& logger : recording.loggers)
    if (const double period = median_period(logger.time); period > max_sampling_period)
      return error("{}: {:.3g} samples a second are too few to follow a machine; record {} or more", logger.name,
                   1.0 / period, advised_sampling_rate);
  MendedTimeStamps stamps = mend_time_stamps(recording, threads);
  const InsRecording& mended = stamps.recording ? *stamps.recording : recording;
  KINFER_TRY(chosen, select_moving_sensors(mended, sensors, root, motion));
  const std::vector<Finding> duplicates = duplicate_findings(mended, chosen.sensors);
  if (!duplicates.empty() && chosen.sensors.size() == 2)
    return error("{} and {} hold the same measurements: one sensor under two names",
                 duplicates.front().values.text("first"), duplicates.front().values.text("second"));
  Session session(recording);
  if (chosen.sensors.size() < recording.sensors.size())
    session.part_ = select_sensors(mended, chosen.sensors);
  else
    session.part_ = std::move(stamps.recording);
  session.clock_ = synchronise_sensors(session.selected(), motion, threads);
  session.findings_ = std::move(stamps.findings);
  std::ranges::move(chosen.findings, std::back_inserter(session.findings_));
  return session;
}

bool Session::has_idle_sensors() const {
  return std::ranges::find(findings_, FindingKind::idle, &Finding::kind) != findings_.end();
}

Result<void> Session::restrict_to(RecordingSelection part) {
  if (++restrictions_ > max_restrictions) return error("the recording has more faults than can be separated");
  identify::restrict_to(clock_, selected(), part);
  part_ = select_sensors(selected(), part.sensors);
  std::ranges::move(part.findings, std::back_inserter(findings_));
  return {};
}

bool Session::update_clocks(const std::vector<ResidualClock>& residual) {
  return identify::update_clocks(clock_, selected(), residual) && ++clock_updates_ < max_clock_updates;
}

ClockReport Session::report_clocks(const std::vector<ResidualClock>& residual,
                                   const std::vector<std::vector<std::size_t>>& groups) const {
  return identify::report_clocks(relative_to_groups(clock_, selected(), groups), selected(), residual);
}

std::optional<RecordingSelection> select_consistent_part(const OrderedMotion& ordered,
                                                         const std::vector<PairConnection>& connections,
                                                         const std::optional<std::string>& root,
                                                         MachineSeparation separation, int threads) {
  const std::size_t segments = ordered.motion.segments.size();
  if (is_unconnected(connections)) return std::nullopt;
  if (const auto remount = find_remount(ordered, threads)) {
    RecordingSelection part = select_all(segments);
    (remount->before_is_more_informative ? part.end : part.begin) =
        remount->before_is_more_informative ? remount->begin : remount->end;
    part.findings.push_back(finding_about(*remount, ordered.motion));
    return part;
  }
  if (separation == MachineSeparation::none) return std::nullopt;
  RecordingSelection machine = select_connected(ordered, connections, root, threads);
  if (machine.sensors.size() == segments) machine = select_machine(ordered, root, connections);
  if (machine.sensors.size() == segments) return std::nullopt;
  return machine;
}

}  // namespace kinfer::identify
