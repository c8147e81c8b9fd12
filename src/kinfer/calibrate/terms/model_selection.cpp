// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/model_selection.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/terms/extrapolation_splits.hpp"
#include "kinfer/calibrate/terms/model_terms.hpp"
#include "kinfer/calibrate/validation/gross_errors.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::calibrate {
namespace {

/// Errors of held-out rows [m], each for the fit without that row.
struct HoldoutErrors {
  std::vector<Estimate> split_fits;  // one per split
  std::vector<double> errors;
  std::vector<int> row;  // of each error
};

/// A model fitted to all rows, and its held-out errors: `near` by interpolation (random folds), `far` by extrapolation
/// (splits along the principal directions of the joint positions).
struct CandidateModel {
  Estimate fit;
  HoldoutErrors interpolation, extrapolation;
};

Estimate fit_rows(const Chain& start, const ParameterSet& set, const PoseSet& rows, const CalibrationTask& task,
                  const BundleOptions& options, const Observer& observer = {}) {
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
  const auto headline = primary_measurement_kind(rows);
  if (!headline) return holdout_errors;
  for (std::size_t i = 0; i < splits.size(); ++i) {
    const PoseSet evaluated = select(rows, splits[i].holdout);
    const std::vector<double> errors =
        primary_errors(holdout_errors.split_fits[i].chain, select(rows, splits[i].train), evaluated);
    for (std::size_t k = 0; k < errors.size(); ++k) {
      holdout_errors.errors.push_back(errors[k]);
      holdout_errors.row.push_back(splits[i].holdout[residual_kind(*headline).row(evaluated, k)]);
    }
  }
  return holdout_errors;
}

bool contains(const std::vector<Outlier>& list, int row) {
  return std::any_of(list.begin(), list.end(), [&](const Outlier& o) { return o.row == row; });
}

/// Statistics over the rows without gross errors.
ErrorStatistics evaluated(const HoldoutErrors& holdout_errors, const std::vector<Outlier>& gross_errors) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < holdout_errors.errors.size(); ++i)
    if (!contains(gross_errors, holdout_errors.row[i])) errors.push_back(holdout_errors.errors[i]);
  return error_statistics(errors);
}

ErrorStatistics training_statistics(const CandidateModel& tried, const PoseSet& rows) {
  const PoseSet inliers = select(rows, without(all_rows(rows), tried.fit.outliers));
  return error_statistics(primary_errors(tried.fit.chain, rows, inliers));
}

/// Paired comparison of the held-out errors of two models, without the rows that are outliers of both.
struct HoldoutComparison {
  double mean_before = 0.0, mean_after = 0.0, worst_before = 0.0, worst_after = 0.0;  // [m]
  double t = 0.0;  // mean reduction of the error divided by its standard error
};

HoldoutComparison compare_holdout(const CandidateModel& before, const CandidateModel& after,
                                  HoldoutErrors CandidateModel::*which) {
  const HoldoutErrors &old = before.*which, &now = after.*which;
  std::vector<double> reduction, a, b;
  for (std::size_t i = 0; i < old.errors.size(); ++i) {
    if (contains(before.fit.outliers, old.row[i]) && contains(after.fit.outliers, old.row[i])) continue;
    reduction.push_back(old.errors[i] - now.errors[i]);
    a.push_back(old.errors[i]), b.push_back(now.errors[i]);
  }
  HoldoutComparison c;
  if (reduction.size() < 2) return c;
  c.mean_before = mean(a), c.mean_after = mean(b);
  c.worst_before = *std::max_element(a.begin(), a.end()), c.worst_after = *std::max_element(b.begin(), b.end());
  c.t = mean(reduction) / (standard_deviation(reduction) / std::sqrt(static_cast<double>(reduction.size())) + 1e-300);
  return c;
}

std::string in_fine_millimetres(double metres) {
  return fmt::format("{:.4f} mm", 1e3 * metres);
}

/// Whether the terms improve the interpolation error; `why` gets the figures and the reason.
bool improves_interpolation(const HoldoutComparison& c, double geometry_worst, std::string& reason) {
  constexpr double least_t = 2.5;           // standard errors
  constexpr double least_reduction = 0.01;  // fraction of the mean error: a smaller reduction does not justify a term
  constexpr double worst_ratio = 1.0;       // times the largest error before: no pose may pay for the others
  const std::string means = fmt::format("the held-out mean goes from {} to {}", in_fine_millimetres(c.mean_before),
                                        in_fine_millimetres(c.mean_after));
  if (c.mean_after >= (1.0 - least_reduction) * c.mean_before) {
    reason = "refused: " + means;
    return false;
  }
  if (c.t < least_t) {
    reason = fmt::format("refused: {}, which chance explains ({:.1f} standard errors)", means, c.t);
    return false;
  }
  if (c.worst_after > worst_ratio * std::max(c.worst_before, geometry_worst)) {
    reason = fmt::format("refused: {}, but the worst held-out error rises from {} to {}", means,
                         in_fine_millimetres(c.worst_before), in_fine_millimetres(c.worst_after));
    return false;
  }
  reason = fmt::format("{} ({:.0f} standard errors)", means, c.t);
  return true;
}

/// Whether terms that improve interpolation do not degrade extrapolation; completes the sentence.
bool preserves_extrapolation(const HoldoutComparison& extrapolation, std::string& reason) {
  constexpr double extrapolation_ratio = 1.02;  // times the error before
  const std::string means = fmt::format("from {} to {}", in_fine_millimetres(extrapolation.mean_before),
                                        in_fine_millimetres(extrapolation.mean_after));
  if (extrapolation.mean_after > extrapolation_ratio * extrapolation.mean_before) {
    reason = "refused: " + reason + ", but beyond the fitted poses the mean rises " + means;
    return false;
  }
  reason = "taken: " + reason + (extrapolation.mean_before > 0.0 ? "; beyond the fitted poses " + means : "");
  return true;
}

/// Which of the added parameters the data determine.
void count_determined(SelectionStep& entry, const ModelTerm& model_term, const Estimate& fit) {
  entry.parameter_count = static_cast<int>(model_term.parameters.size());
  for (const Parameter& term : model_term.parameters) {
    const auto value = std::find_if(fit.values.begin(), fit.values.end(),
                                    [&](const ParameterEstimate& v) { return v.name == term.name; });
    if (value != fit.values.end() && value->identifiable)
      ++entry.determined_count;
    else
      entry.undetermined_parameters.push_back(term.name);
  }
}

class ModelSelector {
 public:
  ModelSelector(const CalibrationTask& task, const PoseSet& rows, const std::vector<Split>& splits,
                const CalibrationOptions& options, const Observer& observer)
      : task_(task),
        rows_(rows),
        splits_(splits),
        extrapolation_splits_(extrapolation_splits(rows)),
        options_(options),
        observer_(observer) {}

  SelectedModel run(const Estimate& geometry) {
    start_from(geometry);
    const auto* named = std::get_if<FixedModel>(&options_.model);
    for (const std::string& name : named ? named->model_terms : model_term_names()) test_term(name, named != nullptr);
    if (selection_.selected != "geometry")  // identifiability is computed for the selected model only
      current_.fit = fit_rows(current_.fit.chain, current_.fit.parameters, rows_, task_,
                              {.initial_guess = InitialGuess::near_optimum});
    const std::vector<Outlier> gross_errors = find_gross_error_rows(geometry);
    for (std::size_t i = 0; i < selection_.model_terms.size(); ++i)
      selection_.model_terms[i].holdout = evaluated(held_out_[i], gross_errors);
    return {current_.fit, current_.interpolation.split_fits, selection_, gross_errors};
  }

 private:
  void start_from(const Estimate& geometry) {
    current_.fit = geometry;
    current_.interpolation = holdout_errors_of(current_, geometry.parameters, splits_);
    if (std::holds_alternative<CrossValidatedModel>(options_.model))
      current_.extrapolation = holdout_errors_of(current_, geometry.parameters, extrapolation_splits_);
    SelectionStep entry{.name = "geometry", .description = "the complete geometric set", .selected = true};
    entry.train = training_statistics(current_, rows_);
    entry.parameter_count = static_cast<int>(geometry.values.size());
    entry.determined_count = geometry.identifiability.rank;
    entry.reason = "where every robot begins";
    geometry_worst_ = evaluated(current_.interpolation, geometry.outliers).max;
    add(entry, current_.interpolation);
    selection_.selected = "geometry";
  }

  void add(const SelectionStep& entry, const HoldoutErrors& holdout_errors) {
    selection_.model_terms.push_back(entry);
    held_out_.push_back({{}, holdout_errors.errors, holdout_errors.row});
  }

  std::vector<Outlier> find_gross_error_rows(const Estimate& geometry) const {
    std::vector<Outlier> gross_errors = without_explained_rows(geometry.outliers, current_.fit, rows_, rows_);
    for (const Outlier& outlier : gross_errors_of_both_models(geometry, current_.fit, rows_))
      if (!contains(gross_errors, outlier.row)) gross_errors.push_back(outlier);
    return gross_errors;
  }

  HoldoutErrors holdout_errors_of(const CandidateModel& tried, const ParameterSet& set,
                                  const std::vector<Split>& splits) const {
    return cross_validate(tried.fit, set, rows_, splits, task_, options_.threads);
  }

  /// Extrapolation is tested only where interpolation improves.
  bool is_accepted(CandidateModel& next, const ParameterSet& set, std::string& reason) const {
    if (!improves_interpolation(compare_holdout(current_, next, &CandidateModel::interpolation), geometry_worst_,
                                reason))
      return false;
    next.extrapolation = holdout_errors_of(next, set, extrapolation_splits_);
    return preserves_extrapolation(compare_holdout(current_, next, &CandidateModel::extrapolation), reason);
  }

  void test_term(const std::string& name, bool forced) {
    const ModelTerm model_term = make_model_term(current_.fit.chain, name, task_, rows_, current_.fit);
    SelectionStep entry{.name = name, .description = model_term.description};
    entry.parameter_count = static_cast<int>(model_term.parameters.size());
    if (!model_term.skipped.empty()) {
      skip(entry, model_term.skipped);
      return;
    }
    ParameterSet set = current_.fit.parameters;
    set.parameters.insert(set.parameters.end(), model_term.parameters.begin(), model_term.parameters.end());
    CandidateModel next;
    next.fit = fit_rows(model_term.nominal, set, rows_, task_, {.detail = Detail::numbers_only}, observer_);
    count_determined(entry, model_term, next.fit);
    if (entry.determined_count == 0 && !forced) {
      skip(entry, "these poses do not excite its terms");
      return;
    }
    next.interpolation = holdout_errors_of(next, set, splits_);
    entry.train = training_statistics(next, rows_);
    entry.selected = forced || is_accepted(next, set, entry.reason);
    if (forced) entry.reason = "asked for";
    add(entry, next.interpolation);
    if (entry.selected) {
      current_ = std::move(next);
      selection_.selected += " + " + name;
    }
  }

  void skip(SelectionStep& entry, const std::string& reason) {
    entry.skipped = true;
    entry.reason = "locked: " + reason;
    add(entry, {});
  }

  const CalibrationTask& task_;
  const PoseSet& rows_;
  const std::vector<Split>& splits_;
  std::vector<Split> extrapolation_splits_;
  const CalibrationOptions& options_;
  const Observer& observer_;
  CandidateModel current_;
  ModelSelection selection_;
  std::vector<HoldoutErrors> held_out_;  // errors of each tested model
  double geometry_worst_ = 0.0;
};

}  // namespace

SelectedModel select_model(const CalibrationTask& task, const PoseSet& rows, const Estimate& geometry,
                           const std::vector<Split>& splits, const CalibrationOptions& options,
                           const Observer& observer) {
  return ModelSelector(task, rows, splits, options, observer).run(geometry);
}

}  // namespace kinfer::calibrate
