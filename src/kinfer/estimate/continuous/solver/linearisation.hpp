// SPDX-License-Identifier: Apache-2.0
// Linearised residuals of a continuous-time fit, by time segments, and their normal equations as a bordered band
// matrix.
#pragma once

#include <optional>

#include "kinfer/estimate/continuous/model/bias_process.hpp"
#include "kinfer/estimate/continuous/model/interval_motion.hpp"
#include "kinfer/estimate/continuous/solver/cost.hpp"
#include "kinfer/estimate/continuous/solver/fact_residuals.hpp"
#include "kinfer/linalg/band_segment.hpp"

namespace kinfer {

/// Negative gradient of half the cost of one interval's measurements.
struct IntervalGradient {
  VectorXd band;  ///< order · spline dimensions: of the coefficients with support in the interval
  VectorXd border;
};

/// The residuals linearised at x. The constructor's arguments must outlive it.
class InsLinearisation {
 public:
  InsLinearisation(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

  /// Normal equations of a time segment: band (spline coefficients) and border (global parameters), including the
  /// priors on the spline coefficients and the facts.
  BandSegmentSum sum(const TimeSegment& time_segment) const;

  /// Back-substitution: the same for the spline coefficients only, given the step `border` of the global parameters as
  /// this segment sees it; without it the global parameters are held.
  BandSegmentSum sum_back_substituted(const TimeSegment& time_segment,
                                      const std::optional<VectorXd>& border = {}) const;

  /// Derivatives by the global parameters, one for each row of the facts that do not depend on the motion.
  std::vector<VectorXd> constant_facts() const;

  /// Of each interval of a time segment; measurements only, without priors and facts.
  std::vector<IntervalGradient> gradients(const TimeSegment& time_segment) const;

  /// Residuals of the measurements of a time segment times their robust weights, one vector for each interval and part
  /// of a sensor.
  std::vector<VectorXd> residuals(const TimeSegment& time_segment) const;

 private:
  void add_spline_prior(BandSegmentSum& sum, const TimeSegment& time_segment) const;
  void add_facts(BandSegmentSum& sum, const TimeSegment& time_segment) const;
  void add_facts_back_substituted(BandSegmentSum& sum, const TimeSegment& time_segment,
                                  const std::optional<VectorXd>& border) const;

  const InsProblem& problem_;
  const InsLayout& layout_;
  const InsUnknowns& x_;
  std::vector<InsFactRows> facts_;
};

/// Derivatives of the measurements by a time segment's spline coefficients at x, transposed, times residuals of the
/// same rows. Not robustly weighted.
VectorXd spline_product(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                        const TimeSegment& time_segment, const std::vector<VectorXd>& residuals);

}  // namespace kinfer
