// SPDX-License-Identifier: Apache-2.0
// truth.json of `kinfer simulate`, read back.
#pragma once

#include <filesystem>

#include "kinfer/base/result.hpp"
#include "kinfer/simulate/ground_truth.hpp"

namespace kinfer::study {

Result<MachineTruth> read_truth(const std::filesystem::path& path);

}  // namespace kinfer::study
