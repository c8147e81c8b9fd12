// Whole text files, with errors that say what is wrong with the path.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"

namespace kinfer {

/// The file's bytes. Missing, a folder, unreadable or empty: one sentence.
Result<std::string> read_text_file(const std::filesystem::path& path);

/// Writes beside `path` and renames, so that a reader never sees half a file.
Result<void> write_text_file(const std::filesystem::path& path, std::string_view text);

/// Makes the folder where it is absent, and proves that files can be written there, leaving none behind.
Result<void> make_writable_folder(const std::filesystem::path& folder);

}  // namespace kinfer
