// SPDX-License-Identifier: Apache-2.0
// Findings about pose sets in words.
#pragma once

#include <string>

#include "kinfer/evidence/facts/findings.hpp"

namespace kinfer::words {

std::string pose_set_finding_sentence(const Finding& finding);
std::string pose_set_finding_suggestion(const Finding& finding);

/// The finding and its correction as one sentence for a note.
std::string pose_set_finding_note(const Finding& finding);

}  // namespace kinfer::words
