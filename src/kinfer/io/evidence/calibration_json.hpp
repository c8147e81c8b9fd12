// SPDX-License-Identifier: Apache-2.0
// evidence.json of `calibrate` (docs/formats.md, kinfer-evidence/1), written and read. SI throughout; the same bytes
// for the same evidence, and for evidence that was read.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/calibration/calibration_evidence.hpp"

namespace kinfer {

/// What the file states of a calibration: sentences made, drawings rounded.
CalibrationEvidence calibration_evidence(const Calibration& calibration, const Provenance& provenance);

nlohmann::ordered_json calibration_json(const CalibrationEvidence& evidence);
std::string format_calibration_evidence(const CalibrationEvidence& evidence);

/// Error: the path of the first value that is missing or of another type, and what was expected.
Result<CalibrationEvidence> read_calibration_evidence(std::string_view text);

/// Verdict and headline figures as one line, for --json.
std::string format_calibration_headline(const Calibration& calibration);

/// JSON Schema of what is written.
nlohmann::ordered_json calibration_schema();

}  // namespace kinfer
