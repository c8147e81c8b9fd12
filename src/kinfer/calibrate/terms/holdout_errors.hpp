// SPDX-License-Identifier: Apache-2.0
// Held-out errors of a candidate model: each measurement is predicted by a fit without its row.
#pragma once

#include <vector>

#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/evidence/calibration/model_selection.hpp"
#include "kinfer/measurement/split.hpp"

namespace kinfer::calibrate {

/// Errors of held-out rows [m], each for the fit without that row.
struct HoldoutErrors {
  std::vector<Estimate> split_fits;  ///< one per split
  std::vector<double> errors;
  std::vector<int> row;   ///< of each error
  std::vector<int> pose;  ///< that was commanded, of each error
};

/// Fits to all rows, with the fixtures that the rows refer to.
Estimate fit_rows(const Chain& start, const ParameterSet& set, const PoseSet& rows, const CalibrationTask& task,
                  const BundleOptions& options, const Observer& observer = {});

/// Refits the model of `fit` to the training rows of each split and predicts the others.
HoldoutErrors cross_validate(const Estimate& fit, const ParameterSet& set, const PoseSet& rows,
                             const std::vector<Split>& splits, const CalibrationTask& task, int threads);
/// The same for several groups of splits at once, which keeps more threads busy.
std::vector<HoldoutErrors> cross_validate(const Estimate& fit, const ParameterSet& set, const PoseSet& rows,
                                          const std::vector<std::vector<Split>>& groups, const CalibrationTask& task,
                                          int threads);

/// Errors of the held-out rows for one chain per split, fitted to its training rows.
HoldoutErrors evaluate_holdout(const std::vector<Chain>& chains, const PoseSet& rows, const std::vector<Split>& splits,
                               int threads);

/// Statistics over the rows without gross errors.
ErrorStatistics statistics_without(const HoldoutErrors& holdout_errors, const std::vector<Outlier>& gross_errors);

/// Compares the held-out errors of two fits without the rows that are outliers of both, each commanded pose
/// by its mean.
ErrorChange compare_holdout(const HoldoutErrors& before, const std::vector<Outlier>& outliers_before,
                            const HoldoutErrors& after, const std::vector<Outlier>& outliers_after);

bool contains_row(const std::vector<Outlier>& list, int row);

}  // namespace kinfer::calibrate
