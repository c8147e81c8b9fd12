// SPDX-License-Identifier: Apache-2.0
// Sections of the calibration report below the first screen.
#pragma once

#include "kinfer/evidence/calibration/calibration_evidence.hpp"
#include "kinfer/report/parts/html.hpp"

namespace kinfer::report {

html::Section errors_section(const CalibrationEvidence& evidence);
html::Section parameters_section(const CalibrationEvidence& evidence);
html::Section uncertainty_section(const CalibrationEvidence& evidence);
html::Section model_section(const CalibrationEvidence& evidence);   ///< the model selection
html::Section doubts_section(const CalibrationEvidence& evidence);  ///< outliers, findings and notes
html::Section search_section(const CalibrationEvidence& evidence);

}  // namespace kinfer::report
