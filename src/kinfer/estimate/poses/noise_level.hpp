// SPDX-License-Identifier: Apache-2.0
// Noise level of the measurements: the instrument's specification, increased where the residuals are larger.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "kinfer/estimate/poses/pose_residuals.hpp"

namespace kinfer {

/// Standard deviation per axis to be added in quadrature to the instrument's specification so that the typical residual
/// is explained: model error, and all of the noise if no instrument is given. One per kind of measurement: [m], [rad]
/// or [m/s²].
struct ExcessNoise {
  std::array<double, measurement_kinds> of{};
};

/// Estimated from the median block of each kind, hence robust against a minority of outliers. `effective_parameters`:
/// number of parameters determined by the data, by which the redundancy is reduced.
ExcessNoise excess_noise(const Chain& chain, const PoseSet& data, const std::optional<Instrument>& instrument,
                         double effective_parameters, int threads = 1);
/// The same at poses that are known.
ExcessNoise excess_noise(const ResidualContext& scene, const std::optional<Instrument>& instrument,
                         double effective_parameters);

Weights weights_of(const PoseSet& data, const std::optional<Instrument>& instrument, const ExcessNoise& excess);

/// Root mean square of the standard deviations of a kind, in its unit; 0 where none was measured.
double typical_sd(const Weights& weights, const ResidualKind& kind);
/// Of the first kind with such traits that was measured; 0 where none was.
double typical_sd(const Weights& weights, bool (*accepts)(const MeasurementTraits&));

}  // namespace kinfer
