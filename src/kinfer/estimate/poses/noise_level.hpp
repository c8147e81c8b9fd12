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
  /// What all measurements of one quantity at one pose have in common: the error of the model there, where poses were
  /// repeated. Otherwise zero, and part of `of`.
  std::array<double, measurement_kinds> of_pose{};
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

/// In a fit: m measurements that share the error of a pose count as independent ones of their own variance and m times
/// that of the pose.
Weights weights_of(const PoseSet& data, const std::optional<Instrument>& instrument, const ExcessNoise& excess);

/// Of each measurement by itself: its own variance and that of the pose.
Weights weights_of_single(const PoseSet& data, const std::optional<Instrument>& instrument, const ExcessNoise& excess);

/// −2 log of the likelihood of measurements that share the error of a pose, less that of independent ones with the
/// weights of a fit: what scatters within a pose is judged by its own variance. Zero where nothing was repeated.
double evidence_of_repeats(const ResidualContext& scene, const std::optional<Instrument>& instrument,
                           const ExcessNoise& excess);

/// Root mean square of the standard deviations of a kind, in its unit; 0 where none was measured.
double typical_sd(const Weights& weights, const ResidualKind& kind);
/// Of the first kind with such traits that was measured; 0 where none was.
double typical_sd(const Weights& weights, bool (*accepts)(const MeasurementTraits&));

}  // namespace kinfer
