// SPDX-License-Identifier: Apache-2.0
// The fit of a chain with all that it has: numbers, series of harmonics, a displacement field.
#pragma once

#include "kinfer/estimate/poses/bundle.hpp"

namespace kinfer::calibrate {

/// Fits the series and the field that `start` has, if any, together with the free parameters of `set`; the covariance
/// is that of the parameters whatever these functions are. `start` as for fit_bundle.
Estimate fit_with_functions(const Chain& start, const ParameterSet& set, const PoseSet& rows,
                            const std::optional<Instrument>& instrument, const BundleOptions& options,
                            const Observer& observer = {});

}  // namespace kinfer::calibrate
