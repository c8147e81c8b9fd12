// SPDX-License-Identifier: Apache-2.0
// Chunks of robot logs, unpacked into a buffer that is used again. What a chunk says about its size is not believed.
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include "kinfer/base/result.hpp"

namespace kinfer {

class Decompressor {
 public:
  /// `method`: "" or "none", "zstd", "lz4" (frames), "bz2". `size`: of the unpacked chunk, as the file states it. The
  /// bytes are valid until the next call. Errors: an unknown method, damaged bytes, another size than stated, more than
  /// 1 GiB.
  Result<std::string_view> unpack(std::string_view method, std::string_view packed, std::uint64_t size);

 private:
  std::unique_ptr<char[]> buffer_;
  std::size_t capacity_ = 0;
};

}  // namespace kinfer
