// SPDX-License-Identifier: Apache-2.0
// The report on a calibration.
#pragma once

#include "kinfer/evidence/calibration/calibration_evidence.hpp"
#include "kinfer/report/parts/page.hpp"

namespace kinfer::report {

Page calibration_page(const CalibrationEvidence& evidence);

}  // namespace kinfer::report
