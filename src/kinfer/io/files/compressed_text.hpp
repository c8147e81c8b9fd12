// SPDX-License-Identifier: Apache-2.0
// Text files that are compressed by zstd (log.csv.zst), unpacked into memory.
#pragma once

#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"

namespace kinfer {

bool is_zstd(std::string_view head);

/// Files that are compressed by gzip are not read: the error says what to do with them.
bool is_gzip(std::string_view head);
tl::unexpected<Error> packed_by_gzip(const std::string& name);

/// All frames of the file, one after the other. What a frame states about its size is not believed: memory grows with
/// what comes out. Errors: damaged or cut off; more than 8 GiB.
Result<std::string> unpack_zstd_text(std::string_view packed, const std::string& name_in_messages);

/// At most `most` bytes of the beginning; fewer where the file is damaged.
std::string unpack_zstd_head(std::string_view packed, std::size_t most);

}  // namespace kinfer
