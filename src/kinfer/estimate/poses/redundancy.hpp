// SPDX-License-Identifier: Apache-2.0
// How much of its noise each kind of measurement still shows in its residuals. A few tracker points beside a hundred
// sightings of a theodolite place everything, and are fitted far better than they were measured.
#pragma once

#include "kinfer/estimate/poses/noise_level.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"

namespace kinfer {

/// How many residuals are absorbed: by the parameters that the data determine, and by functions beside them.
struct AbsorbedResiduals {
  double by_parameters = 0.0, by_functions = 0.0;

  double all() const { return by_parameters + by_functions; }
};

/// 1 − trace(A_k (Σ A + P)⁻¹)/n_k with the information A_k of each kind of n_k residuals and that of the priors P,
/// about the chain (variance components, Förstner 1979): as the weight of a kind grows, its residuals and its
/// redundancy vanish together. Functions absorb the same part of each kind. Equal where each kind could have absorbed
/// next to nothing.
RedundancyOfKinds redundancy_of_kinds(const Chain& chain, const ParameterSet& set, const PoseSet& data,
                                      const Weights& weights, const AbsorbedResiduals& absorbed, int threads);

/// The noise of a fit, and the redundancy that goes with it. `parameters`: that the data determine.
ExcessNoise noise_of_fit(const Chain& chain, const ParameterSet& set, const PoseSet& data,
                         const std::optional<Instrument>& instrument, double parameters, int threads = 1);

}  // namespace kinfer
