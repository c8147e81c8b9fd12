// SPDX-License-Identifier: Apache-2.0
// Series of harmonics: the error of a joint as a smooth function of its position, of any form.
//
// Where a joint's error is no sum of few lines, all harmonics from the constant to some order are fitted together, as a
// Gaussian process: the function is a periodic cubic spline whose coefficients, one a knot, are independent and
// N(0, size²) a priori. Where nothing was measured, it returns to zero within two knots. Only four coefficients act at
// one position, so the normal equations of hundreds of them cost little. The size is the one that maximises the
// marginal likelihood (MacKay 1992), and so is the number of knots.
#pragma once

#include <optional>

#include "kinfer/calibrate/functions/chain_series.hpp"
#include "kinfer/estimate/poses/bundle.hpp"

namespace kinfer::calibrate {

struct FoundSeries {
  Chain chain;                     ///< that of the estimate, with series in place of its harmonics
  ParameterSet parameters;         ///< those of the estimate but harmonics
  double log_evidence_gain = 0.0;  ///< log marginal likelihood of the data with them minus without them
};

/// The series that raise the marginal likelihood of the residuals of `fitted`: for which joints, how large, with how
/// many knots. None where no series does.
std::optional<FoundSeries> find_series(const Estimate& fitted, const PoseSet& rows,
                                       const std::optional<Instrument>& instrument, int threads = 1);

/// Fits the series that `start` has, if any, together with the free parameters of `set`; the covariance is that of the
/// parameters whatever the series are. `start` as for fit_bundle.
Estimate fit_with_series(const Chain& start, const ParameterSet& set, const PoseSet& rows,
                         const std::optional<Instrument>& instrument, const BundleOptions& options,
                         const Observer& observer = {});

}  // namespace kinfer::calibrate
