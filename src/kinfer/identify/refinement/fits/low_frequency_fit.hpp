// SPDX-License-Identifier: Apache-2.0
// Fit of a machine's low-frequency motion, after a fit at full bandwidth: what the rigid chain cannot explain at high
// frequencies then no longer biases its lengths (low_frequency_measurements).
#pragma once

#include "kinfer/base/observer.hpp"
#include "kinfer/identify/handover/parameter_covariance.hpp"
#include "kinfer/identify/refinement/fits/refinement_fits.hpp"

namespace kinfer::identify {

/// Result of the fit of the low-frequency motion.
struct LowFrequencyFit {
  RefinementFit fitted;
  double cutoff = 0.0;  ///< [Hz] upper limit of the passband
  ModelError error;     ///< shifts at √2 times the cutoff and with rigid mounts; mount deflection
  std::vector<InsNoise> noise, noise_floor;  ///< of each sensor at full bandwidth, on knots that are fine enough for it
};

/// After a fit at full bandwidth: the chain from the low-frequency motion. Of several cutoffs, that of least
/// uncertainty is selected, standard deviations and the shift towards the next wider passband taken together. Mounts
/// may be compliant (yielding_mounts), and revolute joints are relaxed to spherical ones where that explains
/// significantly more.
LowFrequencyFit fit_low_frequency(const RefinementTask& task, const RefinementFit& found, const Observer& observer);

}  // namespace kinfer::identify
