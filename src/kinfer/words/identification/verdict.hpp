// SPDX-License-Identifier: Apache-2.0
// The verdict on an identification in one sentence.
#pragma once

#include <string>

#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::words {

/// "Use it: 5 joints found, their axes to ± 0.7 mm and ± 0.24 mrad, enough for ...", with the findings that matter; no
/// final stop.
std::string identification_verdict(const Identification& result);
VerdictText identification_verdict_text(const Identification& result);  ///< its parts

}  // namespace kinfer::words
