// SPDX-License-Identifier: Apache-2.0
// What a run will take at least, known before it begins: measured per reading and pose, on long inputs, where both time
// and memory grow in proportion (docs/development/performance.md). Less than the truth by up to a factor of four, so
// that nothing is refused that would have ended in time.
#pragma once

#include <cstdint>
#include <string>

#include "kinfer/base/result.hpp"

namespace kinfer::cli {

struct ExpectedCost {
  std::string of{};                 ///< "720000 rows of 6 sensors"
  double memory = 0.0, time = 0.0;  ///< [bytes], [s]
};

ExpectedCost cost_of_identification(double rows, double sensors);
ExpectedCost cost_of_simulation(double rows, double sensors);
ExpectedCost cost_of_smoothing(double rows, double sensors);
ExpectedCost cost_of_calibration(double poses, double joints);

/// A sentence with the option that allows it, where this is beyond the limits of the process.
Result<void> check_cost(const ExpectedCost& cost);

}  // namespace kinfer::cli
