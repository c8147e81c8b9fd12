// SPDX-License-Identifier: Apache-2.0
// Bootstrap over poses (Efron 1979): spread of the estimate under resampling. Poses are drawn with replacement, all
// measurements of a pose together, and the parameters are refitted.
#pragma once

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"

namespace kinfer {

struct BootstrapOptions {
  int resamples = 1000;
  int max_iterations = 20;  ///< of each refit, which starts at the estimate
  int threads = 0;          ///< 0: all cores; the result does not depend on it
};

struct Bootstrap {
  MatrixXd x;      ///< free parameters x resamples, each refitted
  VectorXd sd;     ///< of each parameter over the resamples
  int failed = 0;  ///< number of refits that did not converge
};

/// Refits the free parameters of `set`, with its priors, from `estimate`. Resample k draws from `rng.stream(k)`.
/// Sets of points only are refitted by the batch kernels, all others by pose_residuals.
Bootstrap bootstrap(const Chain& estimate, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                    const BootstrapOptions& options, Rng rng);

}  // namespace kinfer
