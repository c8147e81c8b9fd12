// The fit of a chain to a pose set: MAP over the full parameter set, weights, outliers, covariance, and what is
// unknown.
//
// One stroke solves gauge, rank and regularisation: the tolerances are Gaussian priors, so parameters that the data
// cannot tell stay at their nominal values. The noise level is the instrument's, or that of the residuals where these
// are larger or the instrument is not known; rows that no such noise explains are given no weight and are listed.
#pragma once

#include <optional>

#include "kinfer/base/observer.hpp"
#include "kinfer/estimate/residuals.hpp"
#include "kinfer/evidence/estimate.hpp"

namespace kinfer {

enum class Outliers { find, believe_all };
enum class Begin {
  anywhere,      ///< noise level, beliefs and parameters are found together, robustly
  near_the_fit,  ///< the start was fitted robustly to these rows and others: what it disbelieves is where to begin
};

enum class Detail {
  all,          ///< with what the data can tell, in words: that costs more than the fit of many rows
  numbers_only  ///< without identifiability, surprise and predicted_error
};

struct BundleOptions {
  int max_iterations = 100;  ///< of each Levenberg-Marquardt run
  Outliers outliers = Outliers::find;
  Begin begin = Begin::anywhere;
  Detail detail = Detail::all;
  double false_alarms = 1e-3;  ///< expected number of good rows called wrong in a whole data set of Gaussian noise
};

/// `start` holds the fixed numbers and the starting values; the priors are centred at the set's nominal values.
Estimate fit_bundle(const Chain& start, const ParameterSet& set, const PoseSet& data,
                    const std::optional<Instrument>& instrument, const BundleOptions& options = {},
                    const Observer& observer = {});

/// Predicted covariance of the tool point at readings q: 3 x 3 [m²].
Mat3 predicted_covariance(const Estimate& estimate, ConstVectorRef q);

/// Predicted error of the tool point [m], the root of that covariance's trace, at many readings (dof x n).
VectorXd predicted_errors(const Estimate& estimate, ConstMatrixRef joints);

}  // namespace kinfer
