// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/calibration/fit_errors.hpp"

#include <algorithm>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {

ErrorStatistics error_statistics(std::span<const double> errors) {
  if (errors.empty()) return {};
  return {mean(errors), rms(errors), standard_deviation(errors), *std::max_element(errors.begin(), errors.end()),
          static_cast<int>(errors.size())};
}

}  // namespace kinfer
