// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/expected_cost.hpp"

#include <cmath>

#include "kinfer/cli/parts/process.hpp"

namespace kinfer::cli {
namespace {

/// A number that a user would type: two digits, rounded up.
double rounded_up(double value) {
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::ceil(value / step) * step;
}

ExpectedCost proportional(std::string of, double count, double bytes_each, double seconds_each) {
  return {std::move(of), count * bytes_each, count * seconds_each};
}

}  // namespace

// An hour of six sensors at 200 Hz: 454 MB and 79 s of two threads' time.
ExpectedCost cost_of_identification(double rows, double sensors) {
  return proportional(fmt::format("{:.0f} rows of {:.0f} sensors", rows, sensors), rows * sensors, 100.0, 10e-6);
}

// 300 s of six sensors at 200 Hz: 111 MB more than 60 s, and 3.6 s.
ExpectedCost cost_of_simulation(double rows, double sensors) {
  return proportional(fmt::format("{:.0f} rows of {:.0f} sensors", rows, sensors), rows * sensors, 380.0, 5e-6);
}

// 600 s of six sensors at 200 Hz: 158 MB more than row by row, and 18.6 s.
ExpectedCost cost_of_smoothing(double rows, double sensors) {
  return proportional(fmt::format("{:.0f} rows of {:.0f} sensors", rows, sensors), rows * sensors, 220.0, 20e-6);
}

// 30 000 poses of six joints: 159 MB more than 3 000, and 4.2 s.
ExpectedCost cost_of_calibration(double poses, double joints) {
  return proportional(fmt::format("{:.0f} poses of {:.0f} joints", poses, joints), poses * joints, 900.0, 6e-6);
}

Result<void> check_cost(const ExpectedCost& cost) {
  constexpr double gigabyte = 1e9;
  const ProcessLimits limits = process_limits();
  if (limits.memory > 0.0 && cost.memory > gigabyte * limits.memory)
    return error("{} take {:.2g} GB of memory or more, and the limit is {:g} GB; --limit-memory {:g} allows it",
                 cost.of, cost.memory / gigabyte, limits.memory, rounded_up(4.0 * cost.memory / gigabyte));
  if (limits.time > 0.0 && cost.time > limits.time)
    return error("{} take {:.2g} s or more, and the limit is {:g} s; --limit-time {:g} allows it", cost.of, cost.time,
                 limits.time, rounded_up(4.0 * cost.time));
  return {};
}

}  // namespace kinfer::cli
