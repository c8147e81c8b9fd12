// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/functions/fit_with_functions.hpp"

#include "kinfer/calibrate/functions/displacement_fields.hpp"
#include "kinfer/calibrate/functions/harmonic_series.hpp"

namespace kinfer::calibrate {

namespace {

bool is_same(const DisplacementField& a, const DisplacementField& b) {
  return a.points.cols() == b.points.cols() && a.points == b.points && a.coefficients == b.coefficients;
}

}  // namespace

Estimate fit_with_functions(const Chain& start, const Chain& nominal, const ParameterSet& set, const PoseSet& rows,
                            const std::optional<Instrument>& instrument, const BundleOptions& options,
                            const Observer& observer) {
  const bool fits_field = !start.field.empty() && (!is_same(start.field, nominal.field) || allows_field(rows));
  return fits_field ? fit_with_field(start, set, rows, instrument, options, observer)
                    : fit_with_series(start, set, rows, instrument, options, observer);
}

}  // namespace kinfer::calibrate
