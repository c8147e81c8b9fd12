// SPDX-License-Identifier: Apache-2.0
// Two tracking models of one machine as one: geometry and scale matrices weighted by what each log tells of them; zeros
// of the older one; biases, noise and all else of the newer one.
//
// The older model is the prior of the newer log, whose own prior is taken out of its estimate: with λ the eigenvalues
// of P^-½ S P^-½, P the prior's covariance, the log alone tells their directions to λ / (1 − λ).
#pragma once

#include "kinfer/identify/update/chain_comparison.hpp"

namespace kinfer::identify {

/// `known` as the changes have moved it. Of what changed, nothing of the older log is used.
TrackingModel combined(const ChainComparison& comparison, const TrackingModel& fresh);

}  // namespace kinfer::identify
