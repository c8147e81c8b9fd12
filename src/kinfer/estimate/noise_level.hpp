// How noisy the measurements really are: the instrument's word, or more where the residuals say so.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "kinfer/estimate/residuals.hpp"

namespace kinfer {

/// Standard deviation per axis that has to be added (in quadrature) to what the instrument promises so that the typical
/// residual is explained: what the model cannot describe, and all noise where the instrument is not known. One a kind
/// of measurement: [m], [rad] or [m/s²].
struct ExcessNoise {
  std::array<double, measurement_kinds> of{};
};

/// Judged by the median block of each kind, so a minority of wrong rows does not matter. `effective_parameters` is how
/// many parameters the data determine: they have absorbed that many residuals.
ExcessNoise excess_noise(const Chain& chain, const PoseSet& data, const std::optional<Instrument>& instrument,
                         double effective_parameters);

Weights weights_of(const PoseSet& data, const std::optional<Instrument>& instrument, const ExcessNoise& excess);

}  // namespace kinfer
