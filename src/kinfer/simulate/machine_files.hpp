// SPDX-License-Identifier: Apache-2.0
// The project's MJCF files, embedded into the library when it is built.
#pragma once

#include <span>
#include <string_view>

namespace kinfer {

struct MachineFile {
  std::string_view name;  ///< the file's name without .xml
  std::string_view mjcf;
};

/// In the order of their names.
std::span<const MachineFile> machine_files();

}  // namespace kinfer
