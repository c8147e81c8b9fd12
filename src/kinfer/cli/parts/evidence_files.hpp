// SPDX-License-Identifier: Apache-2.0
// Writes evidence.json and the report made from it.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/cli/parts/output_folder.hpp"
#include "kinfer/evidence/calibration/calibration_evidence.hpp"
#include "kinfer/evidence/identification/identification_evidence.hpp"
#include "kinfer/evidence/tracking/track_run.hpp"

namespace kinfer::cli {

/// Writes evidence.json, and report.html made from it.
Result<void> write_evidence(OutputFolder& folder, const CalibrationEvidence& evidence);
Result<void> write_evidence(OutputFolder& folder, const IdentificationEvidence& evidence);
Result<void> write_evidence(OutputFolder& folder, const TrackRun& run);

}  // namespace kinfer::cli
