// SPDX-License-Identifier: Apache-2.0
// Reads evidence.json of any kind.
#pragma once

#include <string_view>
#include <variant>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/calibration/calibration_evidence.hpp"
#include "kinfer/evidence/deployment/frames_evidence.hpp"
#include "kinfer/evidence/identification/identification_evidence.hpp"
#include "kinfer/evidence/tracking/track_run.hpp"

namespace kinfer {

using Evidence = std::variant<CalibrationEvidence, IdentificationEvidence, FramesEvidence, TrackRun>;

Result<Evidence> read_evidence(std::string_view text);

}  // namespace kinfer
