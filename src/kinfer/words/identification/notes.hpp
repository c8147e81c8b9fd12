// SPDX-License-Identifier: Apache-2.0
// Sentences of the notes on an identification.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::words {

std::string note_sentence(const IdentificationNote& note);

/// Of the notes, then of the findings with their suggestions.
std::vector<std::string> note_sentences(const Identification& result);

}  // namespace kinfer::words
