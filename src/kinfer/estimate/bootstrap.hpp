// The bootstrap (Efron 1979): how much the estimate would differ had other poses been measured. Poses are drawn with
// replacement, all measurements of a pose together, and the parameters are fitted anew.
#pragma once

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/residuals.hpp"

namespace kinfer {

struct BootstrapOptions {
  int resamples = 1000;
  int max_iterations = 20;  ///< of each refit, which starts at the estimate
  int threads = 0;          ///< 0: all cores; the result does not depend on it
};

struct Bootstrap {
  MatrixXd x;    ///< free parameters x resamples, each refitted
  VectorXd sd;   ///< of each parameter over the resamples
  int poor = 0;  ///< refits that did not converge
};

/// Refits the free parameters of `set`, with its priors, from `estimate`. Resample k draws from `rng.stream(k)`. Points
/// alone are refitted by the batch kernels, anything else by pose_residuals.
Bootstrap bootstrap(const Chain& estimate, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                    const BootstrapOptions& options, Rng rng);

}  // namespace kinfer
