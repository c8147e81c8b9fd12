// Numbers as text, with all digits and no more.
#pragma once

#include <string>

namespace kinfer {

/// The value [SI] in a unit of `factor` SI, so that factor · (text read back) is the value again to one rounding (2e-16
/// of it), and bit for bit where 17 digits can say so. Plain where it is plain: 0.7 m is "700" mm, not
/// "699.9999999999999".
std::string digits(double value, double factor = 1.0);

}  // namespace kinfer
