// SPDX-License-Identifier: Apache-2.0
// Frames from single-joint sweeps in words.
#pragma once

#include <string>

#include "kinfer/evidence/deployment/frame_estimate.hpp"

namespace kinfer::words {

/// The name in the file, or "rows 3 to 15".
std::string sweep_name(const SweepCircle& circle);

/// "joint J1 and joint J2"
std::string base_source(const FrameEstimate& frames);

/// "radius of the sweep of joint J5", or why no radius was used.
std::string tool_length_source(const FrameEstimate& frames);

}  // namespace kinfer::words
