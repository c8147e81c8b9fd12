// SPDX-License-Identifier: Apache-2.0
// What the page's scripts draw, as JSON: the part of evidence.json that web/src/evidence.ts declares, with long signals
// packed.
#pragma once

#include <string>

#include "kinfer/evidence/calibration/calibration_evidence.hpp"
#include "kinfer/evidence/identification/identification_evidence.hpp"

namespace kinfer::report {

std::string script_data(const CalibrationEvidence& evidence);
std::string script_data(const IdentificationEvidence& evidence);

/// Escaped so that JSON cannot close the script element that holds it.
std::string escape_for_script(std::string_view json);

}  // namespace kinfer::report
