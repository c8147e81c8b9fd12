// SPDX-License-Identifier: Apache-2.0
// Figures of the calibration report, as HTML; empty where the evidence holds nothing to draw.
#pragma once

#include <string>

#include "kinfer/evidence/calibration/calibration_evidence.hpp"

namespace kinfer::report {

std::string calibrated_machine_drawing(const CalibrationEvidence& evidence);  ///< chain, poses, error vectors
std::string gain_drawing(const CalibrationEvidence& evidence);                ///< before and after as two bars
std::string error_histogram(const CalibrationEvidence& evidence);
std::string errors_per_pose(const CalibrationEvidence& evidence);
std::string workspace_map(const CalibrationEvidence& evidence);  ///< top and side view
std::string singular_value_plot(const CalibrationEvidence& evidence);
std::string correlation_map(const CalibrationEvidence& evidence);
std::string model_selection_plot(const CalibrationEvidence& evidence);

/// Errors compared on the first screen: lengths, or orientations if nothing else was measured; on held-out rows if
/// there are any.
struct Headline {
  double mean_before = 0.0, mean_after = 0.0, max_before = 0.0, max_after = 0.0;  ///< in `unit`
  int n = 0;
  bool held_out = false;
  std::string unit{};  ///< "mm", "°"
  std::string what{};  ///< "the tool", "the distance", "the tool's orientation"
};
std::string measured_angle(const CalibrationEvidence& evidence);  ///< "the tilt", where no orientation was measured
Headline headline(const CalibrationEvidence& evidence);

/// 95th percentile of the tool error [m]; NaN if there are no rows.
double error_percentile_95(const CalibrationEvidence& evidence);

}  // namespace kinfer::report
