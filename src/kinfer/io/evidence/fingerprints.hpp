// SPDX-License-Identifier: Apache-2.0
// Input files by name and hash, as evidence.json states them.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/facts/provenance.hpp"

namespace kinfer {

/// Base name and SHA-256 of each file, in order; those that cannot be read (pipes) are absent.
std::vector<InputFile> fingerprints(const std::vector<std::string>& paths);

}  // namespace kinfer
