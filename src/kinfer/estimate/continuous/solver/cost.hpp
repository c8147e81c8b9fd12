// SPDX-License-Identifier: Apache-2.0
// Robust cost of a continuous-time fit, and the contribution of each instrument.
//
// A block of measurements (one instrument, one interval) is one term of the robust loss: with s its whitened sum of m
// squares, the cost is s up to a² = m + 4 √(2m) and a² (1 + log(s / a²)) beyond. White noise is thus hardly ever
// down-weighted, while short shocks count little.
#pragma once

#include <limits>

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer {

inline constexpr float no_measurement = std::numeric_limits<float>::quiet_NaN();

/// Residuals of one instrument of a sensor.
struct InstrumentFit {
  double squares = 0.0;                      ///< sum of whitened squared residuals, robust weights applied
  double terms = 0.0;                        ///< number of terms, weights applied
  std::vector<float> block;                  ///< whitened mean square of each interval; NaN: no measurements
  std::vector<std::array<float, 3>> offset;  ///< [sigma] of each interval, per axis; NaN: no measurements
};
struct SensorFit {
  InstrumentFit angular_velocity, force;
};

struct InsCost {
  double total = 0.0;  ///< robust, priors included
  std::vector<SensorFit> sensors;
};
InsCost cost_of(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, int threads);

}  // namespace kinfer
