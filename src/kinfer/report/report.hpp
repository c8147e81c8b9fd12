// SPDX-License-Identifier: Apache-2.0
// report.html: one self-contained file, made from evidence.json alone. It is readable without scripts and on paper;
// with scripts the machine moves and the plots are interactive. Deterministic to the byte.
#pragma once

#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/calibration/calibration_evidence.hpp"
#include "kinfer/evidence/fleet/fleet.hpp"
#include "kinfer/evidence/identification/identification_evidence.hpp"
#include "kinfer/evidence/tracking/track_run.hpp"

namespace kinfer::report {

std::string report_html(const CalibrationEvidence& evidence);
std::string report_html(const IdentificationEvidence& evidence);
std::string report_html(const TrackRun& run);
std::string report_html(const Fleet& fleet);

/// `text`: evidence.json of `calibrate`, `identify` or `track`. Errors: the text is not such a file, with the path of
/// the first wrong value; or evidence of another kind, which has no report.
Result<std::string> report_of_file(std::string_view text);

}  // namespace kinfer::report
