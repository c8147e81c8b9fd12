// SPDX-License-Identifier: Apache-2.0
// Known formats of INS logs: column maps that are compiled in, recognised by the beginning of a file and its name.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "kinfer/io/recording/foreign/ins_map.hpp"

namespace kinfer {

/// All presets, parsed once.
std::span<const InsMap> ins_presets();

/// The preset that most of the file's beginning speaks for; null where none is recognised.
const InsMap* find_preset(std::string_view head, const std::filesystem::path& path);

/// Whether a file without preset names its columns so that they can be guessed: a time or counter, and an instrument.
bool is_foreign_log(std::string_view head);

}  // namespace kinfer
