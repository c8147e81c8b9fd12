// SPDX-License-Identifier: Apache-2.0
// Fast parsing of plain decimals: the inner loop of reading large numeric tables.
#pragma once

#include <cstdint>

namespace kinfer {

/// Reads a plain decimal ("-12.0625", "3e-4") at `at`, up to but not including `end`. Returns the character after it,
/// or null where the text is not a plain decimal of at most 19 digits; the value is then unchanged. Correctly rounded:
/// where the digits fit 53 bits and the power of ten is exact, one multiplication or division rounds correctly (Clinger
/// 1990); otherwise null.
const char* read_plain_decimal(const char* at, const char* end, double& value);

}  // namespace kinfer
