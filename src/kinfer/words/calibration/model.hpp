// SPDX-License-Identifier: Apache-2.0
// Model selection in words.
#pragma once

#include <string>

#include "kinfer/evidence/calibration/model_selection.hpp"

namespace kinfer::words {

/// What the candidate models: "compliance of each revolute joint under gravity".
std::string description(const SelectionStep& step);

/// Why it was accepted, rejected or skipped.
std::string reason(const SelectionStep& step);

}  // namespace kinfer::words
