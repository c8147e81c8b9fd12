// The residuals of a continuous-time fit, interval by interval, and their normal equations as a bordered band.
//
// A block of readings (one instrument, one interval) is one item for the robust loss: with s its whitened square sum of
// m terms, cost s up to a² = m + 4 √(2m), a² (1 + log(s / a²)) beyond. So white noise is never touched, and what shakes
// or hits a sensor for a moment counts little.
#pragma once

#include <limits>

#include "kinfer/estimate/ins_problem.hpp"
#include "kinfer/linalg/bordered_band.hpp"

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

struct Damping {
  double band = 0.0, border = 0.0;  ///< times the diagonal (Marquardt)
};

/// Normal equations at x, eliminated up to the border; memory is that of the band's factor.
BorderedBand eliminated(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                        const Damping& damping, int threads);

/// Gradient of each interval's readings in the border's unknowns when the band follows (`following` of the elimination
/// at x): intervals x border. Its rows sum to about zero at the optimum, their spread is what the data really say.
MatrixXd interval_scores(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                         ConstMatrixRef following, int threads);

}  // namespace kinfer
