// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validated_fit.hpp"

#include <algorithm>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/swarm/swarm_fit.hpp"
#include "kinfer/calibrate/terms/selection/model_selection.hpp"
#include "kinfer/calibrate/validation/gross_errors.hpp"
#include "kinfer/calibrate/validation/thresholds.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {

std::vector<Outlier> with_data_rows(std::vector<Outlier> outliers, const std::vector<int>& rows) {
  for (Outlier& outlier : outliers) outlier.row = rows[outlier.row];
  return outliers;
}

void merge_outliers(std::vector<Outlier>& list, const std::vector<Outlier>& more) {
  for (const Outlier& outlier : more)
    if (std::none_of(list.begin(), list.end(), [&](const Outlier& o) { return o.row == outlier.row; }))
      list.push_back(outlier);
  std::stable_sort(list.begin(), list.end(), [](const Outlier& a, const Outlier& b) { return a.row < b.row; });
}

namespace {

/// Base and tool only, fitted to each split's training rows.
Result<std::vector<Chain>> fit_frames_of_splits(const CalibrationTask& task, const ValidationPlan& plan, int threads) {
  std::vector<Result<Chain>> fits(plan.validation_splits.size(), error(""));
  parallel_for(fits.size(), threads, [&](std::size_t i) {
    fits[i] = fit_frames_only(task, select(task.data, plan.validation_splits[i].train));
  });
  std::vector<Chain> chains;
  for (const Result<Chain>& fit : fits) {
    if (!fit) return forward_error(fit.error());
    chains.push_back(*fit);
  }
  return chains;
}

/// The splits for model selection: those of the validation, or, where the validation rows are never fitted, folds of
/// the fitted rows.
std::vector<Split> selection_splits(const ValidationPlan& plan, const PoseSet& fitted, Rng rng) {
  if (plan.fits_all_rows) return plan.validation_splits;
  return make_row_folds(fitted, thresholds::default_folds, rng);
}

std::vector<ValidationFit> pair_validation_fits(const std::vector<Chain>& before, const std::vector<Estimate>& after) {
  std::vector<ValidationFit> fits;
  for (std::size_t i = 0; i < before.size(); ++i) fits.push_back({before[i], after[i]});
  return fits;
}

Result<CalibrationFit> calibrate_by_least_squares(const CalibrationTask& task, const ValidationPlan& plan,
                                                  const PoseSet& fitted, const CalibrationOptions& options, Rng rng,
                                                  const Observer& observer) {
  KINFER_TRY(before, fit_frames_of_splits(task, plan, options.threads));
  KINFER_TRY(geometry,
             fit_with_scaled_tolerances(task, fitted, options.parameters, rng.stream(2), observer, options.threads));
  const ModelChoice model = allows_model_terms(options) ? options.model : FixedModel{};
  const SelectedModel selected_model = select_model(
      task, fitted, geometry.estimate, selection_splits(plan, fitted, rng.stream(5)), model, options.threads, observer);
  const std::vector<Estimate> after = plan.fits_all_rows ? selected_model.split_fits : std::vector{selected_model.fit};
  KINFER_TRY(gross_errors,
             find_gross_errors(task, plan, options.parameters, geometry.estimate, rng.stream(6), options.threads));
  merge_outliers(gross_errors, with_data_rows(selected_model.gross_errors, plan.fitted));
  return CalibrationFit{selected_model.fit,
                        geometry.scale,
                        pair_validation_fits(before, after),
                        selected_model.model_selection,
                        without_explained_rows(gross_errors, selected_model.fit, fitted, task.data),
                        selected_model.beyond};
}

/// Swarm search on the inlier rows of the least-squares fit.
Result<CalibrationFit> calibrate_by_swarm(const CalibrationTask& task, const ValidationPlan& plan,
                                          const PoseSet& fitted, const CalibrationOptions& options, Rng rng,
                                          const Observer& observer) {
  KINFER_TRY(least_squares_fit,
             fit_with_scaled_tolerances(task, fitted, options.parameters, rng.stream(2), observer, options.threads));
  KINFER_TRY(before, fit_frames_of_splits(task, plan, options.threads));
  const Rng search_rng = rng.stream(3), validation_rng = rng.stream(4);
  const PoseSet inliers = select(fitted, without_outliers(all_rows(fitted), least_squares_fit.estimate.outliers));
  const ToleranceScale scale = least_squares_fit.scale;
  SwarmSearchOptions swarm = *options.swarm_search;
  budget(swarm.search).threads = options.threads;
  const auto search = [&](const PoseSet& rows, Rng draws, const Observer& search_observer) {
    return fit_by_swarm(task, rows, options.parameters, scale, swarm, draws, search_observer);
  };
  KINFER_TRY(estimate, search(inliers, search_rng.stream(0), observer));
  estimate.outliers = least_squares_fit.estimate.outliers;
  if (std::holds_alternative<BpnnPsoOptions>(swarm.search)) {
    KINFER_TRY(runs, swarm_comparison(task, inliers, options.parameters, scale, swarm, least_squares_fit.estimate.chain,
                                      search_rng.stream(1), observer));
    estimate.search.swarm_comparison = runs;
  }
  const std::vector<Outlier> data_outliers = with_data_rows(estimate.outliers, plan.fitted);
  KINFER_TRY(gross_errors, find_gross_errors(task, plan, options.parameters, least_squares_fit.estimate, rng.stream(6),
                                             options.threads));
  std::vector<Result<Estimate>> after(plan.validation_splits.size(), error(""));
  parallel_for(after.size(), options.threads, [&](std::size_t i) {
    after[i] = search(select(task.data, without_outliers(plan.validation_splits[i].train, data_outliers)),
                      validation_rng.stream(i), {});
  });
  CalibrationFit calibrated{estimate, scale, {}, {}, gross_errors};
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!after[i]) return forward_error(after[i].error());
    calibrated.validation_fits.push_back({before[i], *after[i]});
  }
  return calibrated;
}

}  // namespace

Result<CalibrationFit> fit_and_validate(const CalibrationTask& task, const ValidationPlan& plan, const PoseSet& fitted,
                                        const CalibrationOptions& options, Rng rng, const Observer& observer) {
  return options.swarm_search ? calibrate_by_swarm(task, plan, fitted, options, rng, observer)
                              : calibrate_by_least_squares(task, plan, fitted, options, rng, observer);
}

}  // namespace kinfer::calibrate
