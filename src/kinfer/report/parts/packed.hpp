// SPDX-License-Identifier: Apache-2.0
// Long signals embedded in the page: 16-bit quantisation of their range in base64, finer than any screen resolves and a
// third of the size of decimal numbers. Decoded by web/src/packed.ts.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

namespace kinfer::pages {

/// RFC 4648, with padding.
std::string base64(std::span<const unsigned char> bytes);

/// {"zero", "step", "packed"}: value i is zero + step · (16-bit little-endian integer i of the base64 text); 65535
/// encodes a missing value (null). `numbers` is an array of numbers and nulls.
nlohmann::json packed(const nlohmann::json& numbers);

/// The motion of evidence.json with all envelopes packed.
nlohmann::json with_packed_traces(nlohmann::json motion);

}  // namespace kinfer::pages
