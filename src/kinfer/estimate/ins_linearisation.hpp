// The residuals of a continuous-time fit linearised, stretch by stretch, and their normal equations as a bordered band.
#pragma once

#include <optional>

#include "kinfer/estimate/ins_cost.hpp"
#include "kinfer/estimate/ins_fact_rows.hpp"
#include "kinfer/estimate/ins_motion.hpp"
#include "kinfer/estimate/ins_wander.hpp"
#include "kinfer/linalg/band_stretch.hpp"

namespace kinfer {

/// Gradient (minus, of half the cost) of one interval's readings.
struct IntervalGradient {
  VectorXd band;  ///< order · channels: of the coefficients that the interval sees
  VectorXd border;
};

/// The residuals linearised at x. What it is made from must outlive it.
class InsLinearisation {
 public:
  InsLinearisation(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

  /// Normal equations of a stretch's intervals: band and border. Priors on the band and facts are part of them.
  StretchSum sum(const InsStretch& stretch) const;

  /// The same for the band alone, once the border's step is known: `border`, as the stretch's readings see it; where
  /// nothing is given, it is held.
  StretchSum sum_behind(const InsStretch& stretch, const std::optional<VectorXd>& border = {}) const;

  /// Of each interval of a stretch, readings alone: neither priors nor facts.
  std::vector<IntervalGradient> gradients(const InsStretch& stretch) const;

 private:
  void add_band_prior(StretchSum& sum, const InsStretch& stretch) const;
  void add_facts(StretchSum& sum, const InsStretch& stretch) const;
  void add_facts_behind(StretchSum& sum, const InsStretch& stretch, const std::optional<VectorXd>& border) const;

  const InsProblem& problem_;
  const InsLayout& layout_;
  const InsUnknowns& x_;
  std::vector<InsFactRows> facts_;
};

}  // namespace kinfer
