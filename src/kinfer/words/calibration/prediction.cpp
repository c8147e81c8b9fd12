// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/calibration/prediction.hpp"

#include "kinfer/words/language.hpp"

namespace kinfer::words {

std::string no_standard_deviations(const std::string& path) {
  return phrase(
      "no_prediction",
      "{} has no [prediction], so the poses come without standard deviations: calibrate writes it where tool points "
      "were measured",
      path);
}

}  // namespace kinfer::words
