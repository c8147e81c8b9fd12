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

/// Redundancy of each kind over its number of residuals: the part of their squares that the parameters leave.
using RedundancyOfKinds = std::array<double, measurement_kinds>;

/// The same of all kinds: each parameter absorbs one residual. At least a tenth, if there is hardly any redundancy.
RedundancyOfKinds equal_redundancy(const PoseSet& data, double parameters);

/// Estimated from the median block of each kind, hence robust against a minority of outliers.
ExcessNoise excess_noise(const ResidualContext& scene, const std::optional<Instrument>& instrument,
                         const RedundancyOfKinds& redundancy);
/// The same of a chain, with equal redundancy.
ExcessNoise excess_noise(const Chain& chain, const PoseSet& data, const std::optional<Instrument>& instrument,
                         double parameters, int threads = 1);
ExcessNoise excess_noise(const Chain& chain, const PoseSet& data, const std::optional<Instrument>& instrument,
                         const RedundancyOfKinds& redundancy, int threads = 1);

Weights weights_of(const PoseSet& data, const std::optional<Instrument>& instrument, const ExcessNoise& excess);

/// Root mean square of the standard deviations of a kind, in its unit; 0 where none was measured.
double typical_sd(const Weights& weights, const ResidualKind& kind);
/// Of the first kind with such traits that was measured; 0 where none was.
double typical_sd(const Weights& weights, bool (*accepts)(const MeasurementTraits&));

}  // namespace kinfer
