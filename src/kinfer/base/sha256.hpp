// SPDX-License-Identifier: Apache-2.0
// SHA-256 digest of an input, as `sha256sum` prints it, so that users can check which files a result was computed from.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace kinfer {

std::string sha256(std::string_view bytes);  ///< 64 lower-case hexadecimal digits

/// Digest of a file, read in blocks; nullopt if it cannot be read.
std::optional<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace kinfer
