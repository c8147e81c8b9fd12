// SPDX-License-Identifier: Apache-2.0
// Bundle fit of a chain to a pose set: MAP estimate of the full parameter set, noise levels, outliers, covariance and
// identifiability.
//
// The tolerances are Gaussian priors, which fix the gauge, handle rank deficiency and regularise at once: unobservable
// parameters stay at their nominal values. The noise level is that of the instrument's specification, or that of the
// residuals where these are larger or no instrument is given. Measurements that this noise does not explain get no
// weight and are reported as outliers.
#pragma once

#include <optional>

#include "kinfer/base/observer.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"

namespace kinfer {

enum class Outliers { detect, keep_all };
enum class InitialGuess {
  rough,         ///< noise level, inliers and parameters are estimated together under a robust loss
  near_optimum,  ///< the start is a robust fit to a superset of these rows: its outliers are the initial ones
};

enum class Detail {
  all,          ///< including identifiability in words, which for many rows costs more than the fit
  numbers_only  ///< without identifiability, negative log evidence and predicted error
};

struct BundleOptions {
  int max_iterations = 100;  ///< of each Levenberg-Marquardt run
  Outliers outliers = Outliers::detect;
  InitialGuess initial_guess = InitialGuess::rough;
  Detail detail = Detail::all;
  double absorbed = 0.0;       ///< number of residuals that functions beside the parameters absorb: less redundancy
  double false_alarms = 1e-3;  ///< expected number of inliers rejected per data set under Gaussian noise
  int threads = 1;             ///< at most, 0: all cores; has no effect on the result
};

/// `start` holds the values of the fixed parameters and the initial values of the free ones; the priors are centred at
/// the set's nominal values.
Estimate fit_bundle(const Chain& start, const ParameterSet& set, const PoseSet& data,
                    const std::optional<Instrument>& instrument, const BundleOptions& options = {},
                    const Observer& observer = {});

/// Predicted covariance of the tool point at joint positions q: 3 x 3 [m²].
Mat3 predicted_covariance(const Estimate& estimate, ConstVectorRef q);

/// Predicted error of the tool point [m], square root of that covariance's trace, at many joint positions
/// (dof x n).
VectorXd predicted_errors(const Estimate& estimate, ConstMatrixRef joints);

}  // namespace kinfer
