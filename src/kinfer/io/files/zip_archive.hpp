// SPDX-License-Identifier: Apache-2.0
// Files inside a zip archive, unpacked into memory one by one. What the archive says about sizes is not believed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"

namespace kinfer {

struct ZipEntry {
  std::string name{};  ///< with its folders, "phone/Accelerometer.csv"
  std::uint64_t offset = 0, packed = 0, unpacked = 0;
  std::uint16_t method = 0;  ///< 0: stored, 8: deflated
  bool is_encrypted = false;
};

bool is_zip(std::string_view head);

/// The files of an archive (APPNOTE.TXT 6.3, sections 4.3.7, 4.3.12, 4.3.16). An error where the directory is missing
/// or damaged, where a name is absolute or leads out of the archive (`..`), and for zip64.
Result<std::vector<ZipEntry>> zip_entries(std::string_view archive, const std::string& name_in_messages);

/// The bytes of one file. An error where its compression is unknown, where it is encrypted, damaged, or larger than
/// stated or than 1 GiB.
Result<std::string> unpack_zip_entry(std::string_view archive, const ZipEntry& entry,
                                     const std::string& name_in_messages);

}  // namespace kinfer
