// SPDX-License-Identifier: Apache-2.0
// Long signals embedded in the page: 16-bit quantisation of their range in base64, finer than any screen resolves and a
// third of the size of decimal numbers. Decoded by web/src/packed.ts.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

namespace kinfer::report {

/// RFC 4648, with padding.
std::string base64(std::span<const unsigned char> bytes);

/// {"zero", "step", "packed"}: value i is zero + step · (16-bit little-endian integer i of the base64 text); 65535
/// encodes a value that is not finite.
nlohmann::ordered_json packed(std::span<const double> values);

}  // namespace kinfer::report
