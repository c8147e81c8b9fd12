// SPDX-License-Identifier: Apache-2.0
// Runs that are killed at random moments: the folder of the results holds the old ones or the new ones, never a
// mixture.
#pragma once

#include <cstdint>
#include <filesystem>

#include "kinfer/base/rng.hpp"

namespace kinfer::fuzz {

/// Prints what was found; the number of runs after which the folder held something else. `material`: of make_material.
int count_mixtures(const std::filesystem::path& program, const std::filesystem::path& material, std::uint64_t runs,
                   Rng rng);

}  // namespace kinfer::fuzz
