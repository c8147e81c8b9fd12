// SPDX-License-Identifier: Apache-2.0
// Sentences on what changed on a machine since its last identification.
#pragma once

#include <string>

#include "kinfer/evidence/identification/chain_update.hpp"

namespace kinfer::words {

/// "ins3 sits otherwise on its segment: turned by 1.00° (sd 0.02°), moved by 0.3 mm (sd 0.4 mm)"
std::string change_sentence(const ChainChange& change);

/// "nothing changed since the last identification", or how much; then all changes in one sentence.
std::string update_sentence(const ChainUpdate& update);

}  // namespace kinfer::words
