// SPDX-License-Identifier: Apache-2.0
// Text that is compressed inside the program: the report's scripts.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kinfer::report {

/// The `size` bytes of text that zlib (RFC 1950) made `packed` of.
std::string unpacked_text(std::string_view packed, std::size_t size);

}  // namespace kinfer::report
