#include "kinfer/base/sha256.hpp"

#include <sha2.h>

namespace kinfer {

std::string sha256(std::string_view bytes) {
  char hex[SHA256_DIGEST_STRING_LENGTH];
  SHA256Data(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), hex);
  return hex;
}

}  // namespace kinfer
