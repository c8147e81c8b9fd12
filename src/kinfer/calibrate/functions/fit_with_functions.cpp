// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/functions/fit_with_functions.hpp"

#include "kinfer/calibrate/functions/displacement_fields.hpp"
#include "kinfer/calibrate/functions/harmonic_series.hpp"

namespace kinfer::calibrate {

Estimate fit_with_functions(const Chain& start, const ParameterSet& set, const PoseSet& rows,
                            const std::optional<Instrument>& instrument, const BundleOptions& options,
                            const Observer& observer) {
  const bool has_field = !start.field.empty() && allows_field(rows);
  return has_field ? fit_with_field(start, set, rows, instrument, options, observer)
                   : fit_with_series(start, set, rows, instrument, options, observer);
}

}  // namespace kinfer::calibrate
