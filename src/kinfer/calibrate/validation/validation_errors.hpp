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
/// ball-bars, planes and directions with enough measurements to judge a model, or that with the most where none has
/// enough. Nothing where only orientations or tilts were measured. It belongs to a whole data set: parts of it may lack
/// this kind, and are then judged by nothing.
std::optional<MeasurementKind> primary_measurement_kind(const PoseSet& data);

/// Errors [m] of one kind that shows the tool's position, for a chain that was fitted to `fitted_rows`.
std::vector<double> position_errors_of_fit(MeasurementKind kind, const Chain& chain, const PoseSet& fitted_rows,
                                           const PoseSet& evaluated);

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

/// Probability with which a model that is no better than the nominal one looks as much better on the held-out rows
/// without `skipped`: one-sided paired t test of the errors of each pose, whose repeated rows count once. Nothing with
/// fewer than two poses.
std::optional<double> chance_of_improvement(const std::vector<RowErrors>& rows, const std::vector<int>& skipped,
                                            const PoseSet& data);

/// Expected rms errors of the held-out rows [m]: the instrument's noise, and the uncertainty of the fits without these
/// rows.
struct ExpectedErrors {
  double of_fit = 0.0;    ///< as the residuals say
  double by_noise = 0.0;  ///< if the noise of the instrument were all that is wrong
};

/// Nothing where the instrument is not known.
std::optional<ExpectedErrors> expected_holdout_errors(const EvaluationInputs& evaluated);

}  // namespace kinfer::calibrate
