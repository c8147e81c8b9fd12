// The two files of a result that people and programs read: evidence.json and the report made of it.
#pragma once

#include <filesystem>
#include <string>

#include "kinfer/base/result.hpp"

namespace kinfer::cli {

/// Writes evidence.json as given, and report.html made of it.
Result<void> write_evidence(const std::filesystem::path& folder, const std::string& evidence);

}  // namespace kinfer::cli
