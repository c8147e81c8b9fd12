// The inner loop of reading large numeric tables: one cell to a double, fast where the cell is a plain decimal.
#pragma once

#include <cstdint>

namespace kinfer {

/// Reads a plain decimal ("-12.0625", "3e-4") at `at`, up to but not including `end`. Returns the character after it,
/// or null where the text is no plain decimal of at most 19 digits; the value is then unchanged. Exactly rounded: where
/// the digits fit 53 bits and the power of ten is exact, one multiplication or division is (Clinger 1990); else null.
const char* read_plain_decimal(const char* at, const char* end, double& value);

}  // namespace kinfer
