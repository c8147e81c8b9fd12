// SPDX-License-Identifier: Apache-2.0
// The recording as an identification uses it: some of its sensors, a part of its time, all on one clock. Faults that
// the later steps find restrict it further.
#pragma once

#include "kinfer/identify/screening/connection.hpp"
#include "kinfer/identify/screening/synchronisation.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer::identify {

class Session {
 public:
  /// The named sensors (all, if none is named) without those that never move, on one clock. `recording` must outlive
  /// the session. An error for an unknown name, or for a sensor without specific force or angular velocity.
  static Result<Session> open(const InsRecording& recording, const std::vector<std::string>& sensors,
                              const std::optional<std::string>& root, const SegmentMotionOptions& motion, int threads);

  /// The part that is used, on the common clock.
  const InsRecording& recording() const { return clock_.of(selected()); }
  ClockTreatment clock_treatment() const { return clock_.clock_treatment; }
  bool has_idle_sensors() const;
  const std::vector<Finding>& findings() const { return findings_; }

  /// An error if the recording was restricted too often.
  Result<void> restrict_to(RecordingSelection part);

  /// Applies clock errors that a fit has estimated; true if the steps before the fit should be repeated.
  bool update_clocks(const std::vector<ResidualClock>& residual);

  /// `groups` of sensors share nothing but the ground.
  ClockReport report_clocks(const std::vector<ResidualClock>& residual,
                            const std::vector<std::vector<std::size_t>>& groups) const;

 private:
  explicit Session(const InsRecording& recording) : log_(&recording) {}
  const InsRecording& selected() const { return part_ ? *part_ : *log_; }

  const InsRecording* log_;
  std::optional<InsRecording> part_;  // a copy only if a part is used: an hour's recording is large
  Synchronisation clock_;
  std::vector<Finding> findings_;
  int restrictions_ = 0, clock_updates_ = 0;
};

enum class MachineSeparation { of_unconnected_groups, none };

/// The consistent part of a recording with a remounted sensor, unconnected sensors or several machines; none if all of
/// it is consistent, or nothing is connected with anything. `connections`: of the links of the tree.
std::optional<RecordingSelection> select_consistent_part(const OrderedMotion& ordered,
                                                         const std::vector<PairConnection>& connections,
                                                         const std::optional<std::string>& root,
                                                         MachineSeparation separation, int threads);

}  // namespace kinfer::identify
