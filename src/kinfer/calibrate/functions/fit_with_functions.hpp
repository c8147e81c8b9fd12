// SPDX-License-Identifier: Apache-2.0
// The fit of a chain with all that it has: numbers, series of harmonics, a displacement field.
#pragma once

#include "kinfer/estimate/poses/bundle.hpp"

namespace kinfer::calibrate {

/// Fits the series and the field that `start` has, if any, together with the free parameters of `set`; the covariance
/// is that of the parameters whatever these functions are. `start` as for fit_bundle. A field that `nominal` does not
/// have was found among measurements that these may be a part of: it is fitted anew to whatever rows there are. That of
/// `nominal`, of an earlier calibration, is kept where they do not allow one.
Estimate fit_with_functions(const Chain& start, const Chain& nominal, const ParameterSet& set, const PoseSet& rows,
                            const std::optional<Instrument>& instrument, const BundleOptions& options,
                            const Observer& observer = {});

}  // namespace kinfer::calibrate
