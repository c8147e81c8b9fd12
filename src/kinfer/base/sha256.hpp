// Fingerprint of an input, as `sha256sum` prints it, so that users can check what a result was made from.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace kinfer {

std::string sha256(std::string_view bytes);  ///< 64 lower-case hexadecimal digits

/// The same of a file, read piece by piece; nothing where it cannot be read.
std::optional<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace kinfer
