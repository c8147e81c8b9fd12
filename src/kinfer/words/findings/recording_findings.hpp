// SPDX-License-Identifier: Apache-2.0
// Sentences on what is wrong with a recording. Which values each kind needs stands at its maker in identify.
#pragma once

#include <string>

#include "kinfer/evidence/facts/findings.hpp"

namespace kinfer::words {

/// Whether the finding is about a recording (and not about a pose set).
bool is_recording_finding(FindingKind kind);

/// What was observed, without a final stop. `finding`: about a recording.
std::string recording_finding_sentence(const Finding& finding);

/// What the user can do about it; empty if nothing.
std::string recording_finding_suggestion(const Finding& finding);

}  // namespace kinfer::words
