// SPDX-License-Identifier: Apache-2.0
// Writes evidence.json and the report made from it.
#pragma once

#include <filesystem>
#include <string>

#include "kinfer/base/result.hpp"

namespace kinfer::cli {

/// Writes evidence.json as given, and report.html made from it.
Result<void> write_evidence(const std::filesystem::path& folder, const std::string& evidence);

}  // namespace kinfer::cli
