// SPDX-License-Identifier: Apache-2.0
// The fit of a calibration, by least squares or by a swarm search, and the fits that validate it.
#pragma once

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/validation/validation_errors.hpp"

namespace kinfer::calibrate {

/// The result on the fitted rows, and the fits that validate it.
struct CalibrationFit {
  Estimate estimate;
  ToleranceScale scale;
  std::vector<ValidationFit> validation_fits;
  ModelSelection model_selection;
  std::vector<Outlier> gross_errors;  ///< rows of the whole data set with gross errors, excluded from every evaluation
  std::optional<Estimate> beyond{};   ///< the model to trust far from the fitted rows; none: `estimate`
};

/// `fitted`: the plan's rows of the task's data. Rows of `estimate` are those of `fitted`.
Result<CalibrationFit> fit_and_validate(const CalibrationTask& task, const ValidationPlan& plan, const PoseSet& fitted,
                                        const CalibrationOptions& options, Rng rng, const Observer& observer);

/// Converts row indices from the subset `rows` to the whole data set.
std::vector<Outlier> with_data_rows(std::vector<Outlier> outliers, const std::vector<int>& rows);

/// Adds the entries of `more` whose rows are not listed yet; sorted by row.
void merge_outliers(std::vector<Outlier>& list, const std::vector<Outlier>& more);

}  // namespace kinfer::calibrate
