// SPDX-License-Identifier: Apache-2.0
// evidence.json of `frames` (docs/formats.md), written and read. SI throughout; the same bytes for the same evidence.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/deployment/frames_evidence.hpp"

namespace kinfer {

FramesEvidence frames_evidence(const FrameEstimate& estimate);
std::string format_frames_evidence(const FramesEvidence& evidence);
Result<FramesEvidence> read_frames_evidence(std::string_view text);

/// JSON Schema of what is written.
nlohmann::ordered_json frames_schema();

}  // namespace kinfer
