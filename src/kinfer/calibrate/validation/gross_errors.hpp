// SPDX-License-Identifier: Apache-2.0
// Rows with gross measurement errors, which are excluded from the evaluation of every model: the same rows for all
// models, found before the rows are split.
#pragma once

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/validation/validation_errors.hpp"

namespace kinfer::calibrate {

/// Outliers of the geometric model fitted robustly to all rows. Held-out rows are included for this purpose only.
/// `geometry` is the fit to the plan's fitted rows.
Result<std::vector<Outlier>> find_gross_errors(const CalibrationTask& task, const ValidationPlan& plan,
                                               const ParameterChoice& parameters, const Estimate& geometry, Rng rng,
                                               int threads);

/// Outliers of the richest model, far beyond its (smaller) noise although it was fitted to them, that the geometric
/// model does not explain clearly better. If it does, the richer model is at fault and not the row.
std::vector<Outlier> gross_errors_of_both_models(const Estimate& geometry, const Estimate& richest,
                                                 const PoseSet& rows);

/// Those of `gross_errors` that the selected model does not explain either: a row that it predicts within the noise is
/// valid, however large the error of the geometric model.
std::vector<Outlier> without_explained_rows(const std::vector<Outlier>& gross_errors, const Estimate& chosen,
                                            const PoseSet& fitted, const PoseSet& data);

/// The rows excluded from the hold-out figures.
struct ExcludedRows {
  std::vector<int> rows;  ///< of the data, ascending
  bool too_many = false;  ///< a third of the held-out rows are suspect: the model is at fault, and no row is excluded
  std::size_t suspect_count = 0;  ///< number of suspect held-out rows
};
ExcludedRows select_excluded_rows(const std::vector<Outlier>& gross_errors, const ValidationPlan& plan);

}  // namespace kinfer::calibrate
