// SPDX-License-Identifier: Apache-2.0
// What was changed in the user's robot file, and what could not be.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/calibration/model_patch.hpp"

namespace kinfer::words {

/// "robot_calibrated.urdf is your file with the origins of 6 joints changed, and nothing else."
std::string headline(const ModelPatch& patch);

/// What to do with joint positions, and one sentence for each kind of numbers that the file cannot hold.
std::vector<std::string> remarks(const ModelPatch& patch);

}  // namespace kinfer::words
