// SPDX-License-Identifier: Apache-2.0
// The sentences of a finding, whatever it is about.
#pragma once

#include <string>

#include "kinfer/evidence/findings.hpp"

namespace kinfer::words {

/// What was observed, without a final stop.
std::string sentence(const Finding& finding);

/// What the user can do about it; may be empty.
std::string suggestion(const Finding& finding);

}  // namespace kinfer::words
