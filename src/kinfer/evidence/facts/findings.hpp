// SPDX-License-Identifier: Apache-2.0
// Faults found in a pose set or a recording before the result of a fit is accepted, and what was done about them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/evidence/facts/fact.hpp"

namespace kinfer {

enum class Severity {
  note,     ///< for information; the result is valid
  warning,  ///< costs accuracy, or a few rows
  fault,    ///< invalidates the result unless it is corrected
};

/// "note", "warning", "fault"
constexpr std::string_view name(Severity severity) {
  return severity == Severity::note ? "note" : severity == Severity::warning ? "warning" : "fault";
}

enum class FindingKind {
  rows_shifted,             ///< joint positions and measurements are paired with an offset of some rows
  rows_swapped,             ///< the measurements of two rows are exchanged
  base_moved,               ///< robot, instrument or tool moved between two rows
  base_drifts,              ///< the base or the instrument drifts over the rows
  degrees_for_radians,      ///< joint positions in degrees, read as radians
  radians_for_degrees,      ///< joint positions in radians, read as degrees
  length_unit,              ///< positions, or a prismatic joint, in another length unit
  wrong_sign,               ///< a joint counts in the other sense than the model
  joint_offset,             ///< the zero of a joint is off by 90 or 180 degrees
  columns_swapped,          ///< the columns of two joints are exchanged
  joint_coupled,            ///< one joint moves with another
  mirrored,                 ///< measured positions in left-handed axes
  robot_length_unit,        ///< the robot file's lengths have an implausible size
  orientation_convention,   ///< orientations in another convention
  not_settled,              ///< joint positions were read before the arm came to rest
  joint_lag,                ///< residuals point along the motion from the row before, or to the next one
  gross_outliers,           ///< rows that no noise explains
  joint_hardly_moves,       ///< too little motion to determine a joint's parameters
  outside_limits,           ///< joint positions beyond the limits
  outside_region,           ///< joint positions farther from those of the calibration than these are apart
  duplicate_rows,           ///< rows are copies of one another
  measurement_repeated,     ///< the same measurement at different joint positions
  not_rigid,                ///< the distance between two targets changes
  given_link,               ///< what the recording says about a link of --tree
  loop,                     ///< segments form a kinematic loop
  several_machines,         ///< the recording holds more than one machine
  linkage,                  ///< a sensor on a bar of a linkage
  no_joint,                 ///< a sensor that shares no joint with the others
  fragmented_sensor,        ///< a sensor that measures in pieces too short to know its orientation
  not_connected,            ///< sensors that have nothing to do with the others
  other_machine,            ///< too much differs from the chain that is updated
  mixed_recording,          ///< a sensor that is connected with the others in a part of the recording only
  duplicate_sensor,         ///< two sensors hold the same measurements
  idle,                     ///< sensors that never move
  remounted,                ///< a sensor was remounted during the recording
  clock,                    ///< a sensor's clock is offset or drifts
  timestamp_jitter,         ///< rows were stamped at other times than they were sampled
  clock_unit,               ///< times in another unit than seconds
  clock_counts,             ///< the clock counts rows, so that the sampling rate is a guess
  force_unit,               ///< specific force in another unit than the file says
  force_scale,              ///< all accelerometers read too much or too little alike: more than gravity has anywhere
  rate_unit,                ///< angular rates in another unit than the file says
  field_unit,               ///< magnetic field in another unit than the file says
  repeated_rows,            ///< an instrument's rows are copies of the rows before
  interpolated_rows,        ///< an instrument's rows lie on straight lines between others
  rates_unrelated,          ///< angular rates that tell nothing of how gravity moves in the sensor
  rate_sign,                ///< a gyroscope turns the other way round than gravity
  left_handed,              ///< a sensor's axes are left-handed
  instrument_axes,          ///< an instrument has other axes than the rest of its sensor
  force_sign,               ///< accelerometers that read −g upwards
  opposite_verticals,       ///< sensors that disagree about up and down, none of which is the odd one
  instruments_out_of_step,  ///< an accelerometer lags its gyroscope, or runs ahead of it
  instrument_scale,         ///< a gyroscope or an accelerometer reads a few per cent too much or too little
  clock_rate,               ///< all gyroscopes read too much alike: the clock is slow or fast, or their unit is another
};

/// The stable identifier for programs: "rows_shifted".
std::string_view name(FindingKind kind);
std::optional<FindingKind> finding_kind(std::string_view name);

/// Of all kinds.
std::vector<std::string> finding_kind_names();

/// What was observed, as values; `words` makes the sentence and the suggestion of it.
struct Finding {
  FindingKind kind{};
  Severity severity = Severity::warning;
  std::vector<int> rows{};   ///< from 0; empty: the whole set
  std::vector<int> lines{};  ///< of these rows in the file; from 1
  FactValues values{};
  bool applied = false;                ///< certain, and corrected before the fit
  std::vector<Finding> equivalents{};  ///< other faults that would explain the data equally well
};

/// A fault that was not corrected.
bool invalidates_result(const Finding& finding);

/// Whether the result holds only under an assumption that the data contradict, or do not support.
bool questions_result(const Finding& finding);

}  // namespace kinfer
