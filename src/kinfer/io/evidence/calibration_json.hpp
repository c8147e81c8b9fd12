// SPDX-License-Identifier: Apache-2.0
// Evidence as JSON (docs/formats.md, kinfer-evidence/1). SI throughout; the same bytes for the same evidence.
#pragma once

#include <string>

#include "kinfer/evidence/calibration.hpp"
#include "kinfer/evidence/provenance.hpp"

namespace kinfer {

/// evidence.json of `calibrate`.
std::string format_calibration_evidence(const Calibration& calibration, const Provenance& provenance);

/// Verdict and headline figures as one line, for --json.
std::string format_calibration_headline(const Calibration& calibration);

}  // namespace kinfer
