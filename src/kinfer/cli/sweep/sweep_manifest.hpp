// SPDX-License-Identifier: Apache-2.0
// The manifest in a sweep's folder: which tasks its results are of.
#pragma once

#include <filesystem>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/fleet/manifest.hpp"

namespace kinfer::cli {

/// Errors: the folder holds results and `may_resume` is false; it holds something else; its manifest has none of these
/// tasks, or rows of it are others in `tasks`.
Result<void> check_manifest(const std::filesystem::path& folder, const std::vector<SweepTask>& tasks, bool may_resume);

/// Writes the tasks, with rows that an earlier manifest had and this one has not, so that their results stay explained.
Result<void> update_manifest(const std::filesystem::path& folder, const std::vector<SweepTask>& tasks);

}  // namespace kinfer::cli
