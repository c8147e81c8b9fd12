// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/sha256.hpp"

#include <sha2.h>

namespace kinfer {

std::string sha256(std::string_view bytes) {
  char hex[SHA256_DIGEST_STRING_LENGTH];
  SHA256Data(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), hex);
  return hex;
}

std::optional<std::string> sha256_of_file(const std::filesystem::path& path) {
  char hex[SHA256_DIGEST_STRING_LENGTH];
  if (!SHA256File(path.c_str(), hex)) return std::nullopt;
  return hex;
}

}  // namespace kinfer
