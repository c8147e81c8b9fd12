// SPDX-License-Identifier: Apache-2.0
// Findings in words: what was observed, and what the user can do about it.
#pragma once

#include <string>

#include "kinfer/evidence/facts/findings.hpp"

namespace kinfer::words {

std::string sentence(const Finding& finding);

/// Empty where there is nothing to do.
std::string suggestion(const Finding& finding);

}  // namespace kinfer::words
