// Fingerprint of an input, as `sha256sum` prints it, so that users can check what a result was made from.
#pragma once

#include <string>
#include <string_view>

namespace kinfer {

std::string sha256(std::string_view bytes);  ///< 64 lower-case hexadecimal digits

}  // namespace kinfer
