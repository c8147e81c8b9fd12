// Evidence of `frames` as JSON (docs/formats.md). SI throughout; the same bytes for the same evidence.
#pragma once

#include <string>

#include "kinfer/evidence/frames.hpp"

namespace kinfer {

std::string frames_json(const FramesFound& found);

}  // namespace kinfer
