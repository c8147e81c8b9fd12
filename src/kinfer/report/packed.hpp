// Long signals inside the page: 16-bit steps of their own range in base64, which is finer than any screen and a third
// of the length of decimal numbers. web/src/packed.ts reads them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

namespace kinfer::pages {

/// RFC 4648, with padding.
std::string base64(std::span<const unsigned char> bytes);

/// {"zero", "step", "packed"}: number i is zero + step · (16-bit little-endian i of the base64 text); 65535 stands for
/// a missing one (null). `numbers` is an array of numbers and nulls.
nlohmann::json packed(const nlohmann::json& numbers);

/// The motion of evidence.json with all envelopes packed.
nlohmann::json with_packed_traces(nlohmann::json motion);

}  // namespace kinfer::pages
