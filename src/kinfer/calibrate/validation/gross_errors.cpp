// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/gross_errors.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "kinfer/calibrate/validation/thresholds.hpp"

namespace kinfer::calibrate {
namespace {

/// Largest error of each row, of the primary kind of measurement [m], for a chain that was fitted to `fitted_rows`.
std::map<int, double> errors_by_row(const Chain& chain, const PoseSet& fitted_rows, const PoseSet& rows) {
  std::map<int, double> largest;
  const auto kind = primary_measurement_kind(rows);
  if (!kind) return largest;
  const std::vector<double> errors = position_errors_of_fit(*kind, chain, fitted_rows, rows);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    double& error = largest[residual_kind(*kind).row(rows, i)];
    error = std::max(error, errors[i]);
  }
  return largest;
}

}  // namespace

Result<std::vector<Outlier>> find_gross_errors(const CalibrationTask& task, const ValidationPlan& plan,
                                               const ParameterChoice& parameters, const Estimate& geometry, Rng rng,
                                               int threads) {
  if (plan.fits_all_rows) return geometry.outliers;
  KINFER_TRY(of_all_rows, fit_with_scaled_tolerances(task, task.data, parameters, rng, {}, threads));
  return of_all_rows.estimate.outliers;
}

std::vector<Outlier> gross_errors_of_both_models(const Estimate& geometry, const Estimate& richest,
                                                 const PoseSet& rows) {
  std::vector<Outlier> gross_errors;
  if (richest.outliers.empty()) return gross_errors;
  const std::map<int, double> geometric_errors = errors_by_row(geometry.chain, rows, rows),
                              richest_errors = errors_by_row(richest.chain, rows, rows);
  for (const Outlier& outlier : richest.outliers)
    if (outlier.sigmas > thresholds::gross_sigmas && richest_errors.contains(outlier.row) &&
        geometric_errors.at(outlier.row) >= thresholds::geometric_error_ratio * richest_errors.at(outlier.row))
      gross_errors.push_back(outlier);
  return gross_errors;
}

std::vector<Outlier> without_explained_rows(const std::vector<Outlier>& gross_errors, const Estimate& chosen,
                                            const PoseSet& fitted, const PoseSet& data) {
  const std::map<int, double> error = errors_by_row(chosen.chain, fitted, data);
  std::vector<Outlier> left = gross_errors;
  std::erase_if(left, [&](const Outlier& outlier) {
    return error.contains(outlier.row) && error.at(outlier.row) <= thresholds::explained_sigmas * chosen.sigma;
  });
  return left;
}

ExcludedRows select_excluded_rows(const std::vector<Outlier>& gross_errors, const ValidationPlan& plan) {
  std::set<int> held_out, rows;
  for (const Split& split : plan.validation_splits) held_out.insert(split.holdout.begin(), split.holdout.end());
  for (const Outlier& outlier : gross_errors)
    if (held_out.contains(outlier.row)) rows.insert(outlier.row);
  if (thresholds::max_gross_part * rows.size() >= held_out.size()) return {{}, !rows.empty(), rows.size()};
  return {{rows.begin(), rows.end()}, false, rows.size()};
}

}  // namespace kinfer::calibrate
