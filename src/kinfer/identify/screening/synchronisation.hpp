// SPDX-License-Identifier: Apache-2.0
// Synchronisation of a recording whose sensors may have separate clocks, from their angular velocities alone.
#pragma once

#include <limits>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/refinement/fits/residual_clock.hpp"
#include "kinfer/identify/screening/recording_selection.hpp"
#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer::identify {

struct Synchronisation {
  std::optional<InsRecording> synchronised;  ///< synchronised recording; none if all measurements are used unchanged
  std::vector<ClockCorrection> corrections;  ///< of each sensor, accumulated
  ClockTreatment clock_treatment = ClockTreatment::checked;  ///< how the fit treats the clocks
  /// [s] time window that is used, on the common clock
  double begin = -std::numeric_limits<double>::infinity(), end = std::numeric_limits<double>::infinity();

  const InsRecording& of(const InsRecording& recording) const { return synchronised ? *synchronised : recording; }
};

/// Loggers are always aligned as a whole. A sensor is shifted relative to its own logger only if its offset exceeds the
/// noise and the shift gives a better segment tree.
Synchronisation synchronise_sensors(const InsRecording& recording, const SegmentMotionOptions& options, int threads);

/// Adds the clock corrections estimated by a fit; true if they are so large that the steps before the fit (segment tree
/// and joint types) should be repeated.
bool update_clocks(Synchronisation& clock, const InsRecording& recording, const std::vector<ResidualClock>& found);

/// Restricts the recording to the selected sensors and time span.
void restrict_to(Synchronisation& clock, const InsRecording& recording, const RecordingSelection& part);

struct ClockReport {
  std::vector<SensorClockEstimate> clocks;  ///< one per sensor; empty if all clocks agree
  std::vector<Finding> findings;            ///< one for each clock that was corrected notably
};

/// Nothing tells the time between machines that share nothing but the ground: where all sensors are logged on one
/// clock, each group of sensors is right at its median.
Synchronisation relative_to_groups(Synchronisation clock, const InsRecording& recording,
                                   const std::vector<std::vector<std::size_t>>& groups);

/// The corrections of the sensors' clocks. `residual`: of the last fit, for the standard deviations.
ClockReport report_clocks(const Synchronisation& clock, const InsRecording& recording,
                          const std::vector<ResidualClock>& residual);

}  // namespace kinfer::identify
