// The residuals of a continuous-time fit, interval by interval, and their normal equations as a bordered band.
//
// A block of readings (one instrument, one interval) is one item for the robust loss: with s its whitened square sum of
// m terms, cost s up to a² = m + 4 √(2m), a² (1 + log(s / a²)) beyond. So white noise is never touched, and what shakes
// or hits a sensor for a moment counts little.
#pragma once

#include <limits>
#include <memory>

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

/// Normal equations in the border's unknowns.
struct BorderSum {
  MatrixXd matrix;  ///< lower half
  VectorXd right;
};

/// Gradient (minus, of half the cost) of one interval's readings.
struct IntervalGradient {
  VectorXd band;  ///< order · channels: of the coefficients that the interval sees
  VectorXd border;
};

/// The residuals linearised at x, interval by interval. What it is made from must outlive it.
class IntervalLinearisation {
 public:
  IntervalLinearisation(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);
  ~IntervalLinearisation();

  /// Normal equations of one interval: what it adds to the band and, in `border`, to the border.
  BandSpan span(Eigen::Index interval, BorderSum& border) const;

  /// The same for the band alone, once the border's step is known: `border`, as the interval's readings see it.
  BandSpan span_behind(Eigen::Index interval, ConstVectorRef border) const;

  /// Readings alone: neither priors nor facts.
  IntervalGradient gradient(Eigen::Index interval) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace kinfer
