// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/holdout_errors.hpp"

#include <algorithm>
#include <map>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/functions/fit_with_functions.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/terms/decision.hpp"
#include "kinfer/calibrate/validation/validation_errors.hpp"
#include "kinfer/measurement/commanded_poses.hpp"

namespace kinfer::calibrate {

Estimate fit_rows(const Chain& start, const ParameterSet& set, const PoseSet& rows, const CalibrationTask& task,
                  const BundleOptions& options, const Observer& observer) {
  return fit_with_functions(start, task.nominal, restricted_to_data(set, rows), rows, task.instrument, options,
                            observer);
}

HoldoutErrors cross_validate(const Estimate& fit, const ParameterSet& set, const PoseSet& rows,
                             const std::vector<Split>& splits, const CalibrationTask& task, int threads) {
  return cross_validate(fit, set, rows, std::vector<std::vector<Split>>{splits}, task, threads).front();
}

std::vector<HoldoutErrors> cross_validate(const Estimate& fit, const ParameterSet& set, const PoseSet& rows,
                                          const std::vector<std::vector<Split>>& groups, const CalibrationTask& task,
                                          int threads) {
  std::vector<HoldoutErrors> errors(groups.size());
  std::vector<std::pair<const Split*, Estimate*>> all;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    errors[g].split_fits.resize(groups[g].size());
    for (std::size_t i = 0; i < groups[g].size(); ++i) all.emplace_back(&groups[g][i], &errors[g].split_fits[i]);
  }
  parallel_for(all.size(), threads, [&](std::size_t i) {
    *all[i].second = fit_rows(fit.chain, set, select(rows, all[i].first->train), task,
                              {.initial_guess = InitialGuess::near_optimum, .detail = Detail::numbers_only});
  });
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::vector<Chain> chains;
    for (const Estimate& split_fit : errors[g].split_fits) chains.push_back(split_fit.chain);
    HoldoutErrors evaluated = evaluate_holdout(chains, rows, groups[g], threads);
    errors[g].errors = std::move(evaluated.errors), errors[g].row = std::move(evaluated.row);
    errors[g].pose = std::move(evaluated.pose);
  }
  return errors;
}

HoldoutErrors evaluate_holdout(const std::vector<Chain>& chains, const PoseSet& rows, const std::vector<Split>& splits,
                               int threads) {
  const auto primary = primary_measurement_kind(rows);
  if (!primary) return {};
  std::vector<HoldoutErrors> of_split(splits.size());
  parallel_for(splits.size(), threads, [&](std::size_t i) {
    const PoseSet evaluated = select(rows, splits[i].holdout);
    of_split[i].errors = position_errors_of_fit(*primary, chains[i], select(rows, splits[i].train), evaluated);
    for (std::size_t k = 0; k < of_split[i].errors.size(); ++k)
      of_split[i].row.push_back(splits[i].holdout[residual_kind(*primary).row(evaluated, k)]);
  });
  HoldoutErrors all;
  for (const HoldoutErrors& one : of_split) {
    all.errors.insert(all.errors.end(), one.errors.begin(), one.errors.end());
    all.row.insert(all.row.end(), one.row.begin(), one.row.end());
    for (const int row : one.row) all.pose.push_back(pose_of_row(rows, row));
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
  std::vector<double> a, b, count;
  std::map<int, std::size_t> place_of_pose;
  for (std::size_t i = 0; i < before.errors.size(); ++i) {
    if (contains_row(outliers_before, before.row[i]) && contains_row(outliers_after, after.row[i])) continue;
    const auto [at, is_new] = place_of_pose.try_emplace(before.pose[i], a.size());
    if (is_new) a.push_back(0.0), b.push_back(0.0), count.push_back(0.0);
    a[at->second] += before.errors[i], b[at->second] += after.errors[i], count[at->second] += 1.0;
  }
  for (std::size_t k = 0; k < count.size(); ++k) a[k] /= count[k], b[k] /= count[k];
  return compare_errors(a, b);
}

}  // namespace kinfer::calibrate
