// How well unknowns explain a recording: the robust cost of a continuous-time fit, and what each instrument adds to it.
//
// A block of readings (one instrument, one interval) is one item for the robust loss: with s its whitened square sum of
// m terms, cost s up to a² = m + 4 √(2m), a² (1 + log(s / a²)) beyond. So white noise is never touched, and what shakes
// or hits a sensor for a moment counts little.
#pragma once

#include <limits>

#include "kinfer/estimate/ins_problem.hpp"

namespace kinfer {

inline constexpr float no_reading = std::numeric_limits<float>::quiet_NaN();

/// How well the instruments of one sensor are explained.
struct InstrumentFit {
  double squares = 0.0;                      ///< whitened, robust weights applied
  double terms = 0.0;                        ///< how many, weights applied
  std::vector<float> block;                  ///< whitened squares over terms of each interval; NaN: nothing was said
  std::vector<std::array<float, 3>> offset;  ///< of each interval, an axis each, in sigmas; NaN: nothing was said
};
struct SensorFit {
  InstrumentFit rate, force, field;
};

struct InsCost {
  double total = 0.0;  ///< robust, priors included
  std::vector<SensorFit> sensors;
};
InsCost cost_of(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, int threads);

}  // namespace kinfer
