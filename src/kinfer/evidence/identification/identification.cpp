// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer {

std::string_view name(LinkSearchMethod method) {
  switch (method) {
    case LinkSearchMethod::memetic:
      return "bmp";
    case LinkSearchMethod::bacterial:
      return "bp";
    case LinkSearchMethod::enumeration:
      break;
  }
  return "enum";
}

}  // namespace kinfer
