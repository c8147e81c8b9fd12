// SPDX-License-Identifier: Apache-2.0
// Error statistics of a calibration: before and after, on fitted and on held-out rows.
#pragma once

#include <optional>

#include "kinfer/calibrate/validation/validation_plan.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/evidence/calibration/calibration.hpp"

namespace kinfer::calibrate {

/// Two fits to the training rows of one split.
struct ValidationFit {
  Chain before;    ///< base and tool refitted
  Estimate after;  ///< calibrated
};

/// The primary kind of measurement, whose errors are reported first [m]: the first of points, contacts, distances,
/// ball-bars and planes that was measured. Nothing where only orientations or tilts were measured.
std::optional<MeasurementKind> primary_measurement_kind(const PoseSet& data);

/// Errors of the primary kind of `evaluated` for a chain that was fitted to `fitted_rows`.
std::vector<double> primary_errors(const Chain& chain, const PoseSet& fitted_rows, const PoseSet& evaluated);

/// The inputs that all error statistics share.
struct EvaluationInputs {
  const Chain& nominal;
  const std::optional<Instrument>& instrument;
  const PoseSet& data;
  const ValidationPlan& plan;
  const Chain& frames_only;
  const std::vector<ValidationFit>& fits;  ///< one per split of the plan
  const std::vector<int>& gross_errors;    ///< held-out rows that are excluded
};

/// Fills nominal, before, after and rows from the final estimate (whose outliers are indexed in the whole data set) and
/// the validation fits.
void fill_error_statistics(Calibration& calibration, const EvaluationInputs& evaluated);

/// Expected rms error of the held-out rows [m]: the instrument's noise and the uncertainty of the fits without these
/// rows. Nothing where the instrument is not known.
std::optional<double> expected_holdout_rms(const EvaluationInputs& evaluated);

}  // namespace kinfer::calibrate
