// SPDX-License-Identifier: Apache-2.0
// Numbers as decimal text that reads back to the same value, without spurious digits.
#pragma once

#include <string>

namespace kinfer {

/// The value [SI] in a unit of `factor` SI, so that factor · (text read back) equals the value to one rounding (2e-16
/// relative), and bit for bit where 17 digits allow it. Short where a short decimal exists: 0.7 m is "700" mm, not
/// "699.9999999999999".
std::string format_number(double value, double factor = 1.0);

}  // namespace kinfer
