// SPDX-License-Identifier: Apache-2.0
// Evidence of `frames` as JSON (docs/formats.md). SI throughout; the same bytes for the same evidence.
#pragma once

#include <string>

#include "kinfer/evidence/frame_estimate.hpp"

namespace kinfer {

std::string format_frames_evidence(const FrameEstimate& found);

}  // namespace kinfer
