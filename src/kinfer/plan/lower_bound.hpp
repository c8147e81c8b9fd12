// SPDX-License-Identifier: Apache-2.0
// Lower bound on the error of any choice of poses: a certificate for the design that was found.
//
// Relaxation: poses may be measured in fractions (weights w >= 0 that sum to 1): Λ(w) = I + known + n Σ w_k G_kᵀG_k.
// The mean square error f(w) of the tool is then convex, and no choice of n whole poses is better than its minimum.
// Weights are found by the multiplicative algorithm (Silvey, Titterington, Torsney 1978); since f is convex, its
// tangent at any w bounds it from below, f* >= f(w) − n (max_k d_k − Σ w_k d_k) with d_k = tr(G_k Σ W Σ G_kᵀ), so the
// bound holds wherever it stops.
#pragma once

#include "kinfer/plan/optimal_design.hpp"

namespace kinfer::plan {

/// No `count` candidates, repeated or not, leave a mean square error of the tool [m²] below this.
double mean_square_lower_bound(const DesignProblem& problem, int count);

}  // namespace kinfer::plan
