// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/holdout_errors.hpp"

#include <algorithm>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/terms/decision.hpp"
#include "kinfer/calibrate/validation/validation_errors.hpp"

namespace kinfer::calibrate {

Estimate fit_rows(const Chain& start, const ParameterSet& set, const PoseSet& rows, const CalibrationTask& task,
                  const BundleOptions& options, const Observer& observer) {
  return fit_bundle(start, restricted_to_data(set, rows), rows, task.instrument, options, observer);
}

HoldoutErrors cross_validate(const Estimate& fit, const ParameterSet& set, const PoseSet& rows,
                             const std::vector<Split>& splits, const CalibrationTask& task, int threads) {
  HoldoutErrors holdout_errors;
  holdout_errors.split_fits.resize(splits.size());
  parallel_for(splits.size(), threads, [&](std::size_t i) {
    holdout_errors.split_fits[i] =
        fit_rows(fit.chain, set, select(rows, splits[i].train), task,
                 {.initial_guess = InitialGuess::near_optimum, .detail = Detail::numbers_only});
  });
  std::vector<Chain> chains;
  for (const Estimate& split_fit : holdout_errors.split_fits) chains.push_back(split_fit.chain);
  HoldoutErrors evaluated = evaluate_holdout(chains, rows, splits, threads);
  evaluated.split_fits = std::move(holdout_errors.split_fits);
  return evaluated;
}

HoldoutErrors evaluate_holdout(const std::vector<Chain>& chains, const PoseSet& rows, const std::vector<Split>& splits,
                               int threads) {
  const auto primary = primary_measurement_kind(rows);
  if (!primary) return {};
  std::vector<HoldoutErrors> of_split(splits.size());
  parallel_for(splits.size(), threads, [&](std::size_t i) {
    const PoseSet evaluated = select(rows, splits[i].holdout);
    of_split[i].errors = primary_errors(chains[i], select(rows, splits[i].train), evaluated);
    for (std::size_t k = 0; k < of_split[i].errors.size(); ++k)
      of_split[i].row.push_back(splits[i].holdout[residual_kind(*primary).row(evaluated, k)]);
  });
  HoldoutErrors all;
  for (const HoldoutErrors& one : of_split) {
    all.errors.insert(all.errors.end(), one.errors.begin(), one.errors.end());
    all.row.insert(all.row.end(), one.row.begin(), one.row.end());
  }
  return all;
}

bool contains_row(const std::vector<Outlier>& list, int row) {
  return std::ranges::find(list, row, &Outlier::row) != list.end();
}

ErrorStatistics statistics_without(const HoldoutErrors& holdout_errors, const std::vector<Outlier>& gross_errors) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < holdout_errors.errors.size(); ++i)
    if (!contains_row(gross_errors, holdout_errors.row[i])) errors.push_back(holdout_errors.errors[i]);
  return error_statistics(errors);
}

ErrorChange compare_holdout(const HoldoutErrors& before, const std::vector<Outlier>& outliers_before,
                            const HoldoutErrors& after, const std::vector<Outlier>& outliers_after) {
  std::vector<double> a, b;
  for (std::size_t i = 0; i < before.errors.size(); ++i) {
    if (contains_row(outliers_before, before.row[i]) && contains_row(outliers_after, after.row[i])) continue;
    a.push_back(before.errors[i]), b.push_back(after.errors[i]);
  }
  return compare_errors(a, b);
}

}  // namespace kinfer::calibrate
