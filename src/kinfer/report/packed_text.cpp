// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/packed_text.hpp"

#include <zlib.h>

#include "kinfer/base/expect.hpp"

namespace kinfer::report {

std::string unpacked_text(std::string_view packed, std::size_t size) {
  std::string text(size, '\0');
  uLongf written = size;
  const int code = uncompress(reinterpret_cast<Bytef*>(text.data()), &written,
                              reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  KINFER_EXPECT(code == Z_OK && written == size, "zlib's code {}, {} of {} bytes", code, written, size);
  return text;
}

}  // namespace kinfer::report
