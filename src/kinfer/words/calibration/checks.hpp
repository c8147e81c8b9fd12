// SPDX-License-Identifier: Apache-2.0
// Verification, comparison and compensation of calibrated robots, planned poses, and accuracies that are not used, in
// words.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "kinfer/evidence/deployment/calibration_comparison.hpp"
#include "kinfer/evidence/deployment/compensation.hpp"
#include "kinfer/evidence/deployment/pose_plan.hpp"
#include "kinfer/evidence/deployment/verification.hpp"

namespace kinfer::words {

/// "Still good: the tool is 0.031 mm off on average and 0.062 mm at worst."
std::string verdict(const Verification& verification);

/// "Changed: theta3 (12.1 sigma); the tool differs by …"
std::string verdict(const CalibrationComparison& comparison);

/// "58 of 60 rows are compensated; the corrected model leaves 0.000001 mm at most"
std::string summary(const CompensationSummary& summary);

/// "row 3: the target is out of reach; 4.0000 mm and 0.1000 deg are left"
std::string unreached_row(int row, const CompensatedJoints& joints);

/// Why the nominal base and tool are used for both chains.
std::string compensation_frames_note();

/// "[instrument] states sigma_tilt, but nothing that it concerns was measured"
std::string unused_accuracies(std::span<const std::string_view> keys);

/// "tool error over the workspace (I-optimal)"
std::string description(Criterion criterion);

}  // namespace kinfer::words
