// SPDX-License-Identifier: Apache-2.0
// Whole text files, with errors that state what is wrong with the path.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"

namespace kinfer {

/// The file's bytes. A folder and a missing, unreadable or empty file are errors.
Result<std::string> read_text_file(const std::filesystem::path& path);

/// The first bytes, as many as there are, by which formats are recognised. None of what is no regular file: a pipe is
/// read only once.
std::string read_head(const std::filesystem::path& path, std::size_t size);

/// Writes to a temporary file beside `path` and renames it, so that a reader never sees a partial file. A link stays,
/// and what it points to is replaced; a device or a pipe is written as it is.
Result<void> write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
Result<void> write_text_file(const std::filesystem::path& path, std::string_view text);

/// Creates the folder where it is absent and checks that it is writable with a probe file, of which nothing is left.
Result<void> create_writable_folder(const std::filesystem::path& folder);

}  // namespace kinfer
