// SPDX-License-Identifier: Apache-2.0
// State shared by the checks of the diagnosis, and the quick fit of base and tool that they use.
#pragma once

#include <optional>

#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/evidence/facts/findings.hpp"

namespace kinfer::calibrate {

/// The task with all corrections so far, and the findings.
struct DiagnosisState {
  CalibrationTask task;
  std::vector<Finding> findings;
};

/// Adds a finding and looks up the line numbers of its rows (no rows: the whole set).
void add_finding(DiagnosisState& state, Finding finding);

/// The nominal chain with base and tool fitted to the points alone, and the median remaining error [m]. Fast rather
/// than exact: it only has to distinguish millimetres from decimetres, hundreds of times.
struct FrameFit {
  Chain chain;
  double median_error = 0.0;
};
std::optional<FrameFit> fit_frames_quickly(const Chain& nominal, const PoseSet& data);

/// Largest point error [m] that tolerances and instrument can explain, with base and tool refitted: four times the
/// expected rms.
double max_plausible_error(const CalibrationTask& task);
/// Likewise of orientations [rad].
double max_plausible_angle(const CalibrationTask& task);

}  // namespace kinfer::calibrate
