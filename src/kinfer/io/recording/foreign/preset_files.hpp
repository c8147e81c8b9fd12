// SPDX-License-Identifier: Apache-2.0
// The project's column maps of known log formats, embedded into the library when it is built.
#pragma once

#include <span>
#include <string_view>

namespace kinfer {

struct PresetFile {
  std::string_view name;  ///< the file's name without .toml
  std::string_view toml;
};

/// In the order of their names.
std::span<const PresetFile> preset_files();

}  // namespace kinfer
