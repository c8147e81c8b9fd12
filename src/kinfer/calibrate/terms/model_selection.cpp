// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/model_selection.hpp"

#include <algorithm>

#include "kinfer/calibrate/terms/decision.hpp"
#include "kinfer/calibrate/terms/extrapolation_splits.hpp"
#include "kinfer/calibrate/terms/holdout_errors.hpp"
#include "kinfer/calibrate/terms/model_terms.hpp"
#include "kinfer/calibrate/validation/gross_errors.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

/// A model fitted to all rows, and its held-out errors: by interpolation (random folds), and by extrapolation (splits
/// along the principal directions of the joint positions).
struct CandidateModel {
  Estimate fit;
  HoldoutErrors interpolation, extrapolation;
};

ErrorChange compare(const CandidateModel& before, const CandidateModel& after, HoldoutErrors CandidateModel::*which) {
  return compare_holdout(before.*which, before.fit.outliers, after.*which, after.fit.outliers);
}

ErrorStatistics training_statistics(const CandidateModel& tried, const PoseSet& rows) {
  const PoseSet inliers = select(rows, without_outliers(all_rows(rows), tried.fit.outliers));
  return error_statistics(primary_errors(tried.fit.chain, rows, inliers));
}

/// Which of the added parameters the data determine.
void count_determined(SelectionStep& step, const ModelTerm& model_term, const Estimate& fit) {
  for (const Parameter& parameter : model_term.parameters) {
    const auto value = std::ranges::find(fit.values, parameter.name, &ParameterEstimate::name);
    if (value != fit.values.end() && value->identifiable)
      ++step.determined_count;
    else
      step.undetermined_parameters.push_back(parameter.name);
  }
}

class ModelSelector {
 public:
  ModelSelector(const CalibrationTask& task, const PoseSet& rows, const std::vector<Split>& splits,
                const ModelChoice& model, int threads, const Observer& observer)
      : task_(task),
        rows_(rows),
        splits_(splits),
        extrapolation_splits_(extrapolation_splits(rows)),
        fixed_(std::get_if<FixedModel>(&model)),
        threads_(threads),
        observer_(observer) {}

  SelectedModel run(const Estimate& geometry) {
    start_from(geometry);
    if (fixed_) {
      for (const Term term : fixed_->terms) test_term(term);
    } else {
      for (const TermMaker& maker : term_makers()) test_term(maker.term);
    }
    if (!selected_terms(selection_).empty())  // identifiability is computed for the selected model only
      current_.fit = fit_rows(current_.fit.chain, current_.fit.parameters, rows_, task_,
                              {.initial_guess = InitialGuess::near_optimum});
    const std::vector<Outlier> gross_errors = find_gross_error_rows(geometry);
    for (std::size_t i = 0; i < selection_.steps.size(); ++i)
      selection_.steps[i].holdout = statistics_without(held_out_[i], gross_errors);
    return {current_.fit, current_.interpolation.split_fits, selection_, gross_errors};
  }

 private:
  void start_from(const Estimate& geometry) {
    current_.fit = geometry;
    current_.interpolation = holdout_errors_of(current_, geometry.parameters, splits_);
    if (!fixed_) current_.extrapolation = holdout_errors_of(current_, geometry.parameters, extrapolation_splits_);
    SelectionStep step{.decision = Decision::start};
    step.train = training_statistics(current_, rows_);
    step.parameter_count = static_cast<int>(geometry.values.size());
    step.determined_count = geometry.identifiability.rank;
    geometry_worst_ = statistics_without(current_.interpolation, geometry.outliers).max;
    add(step, current_.interpolation);
  }

  void add(const SelectionStep& step, const HoldoutErrors& holdout_errors) {
    selection_.steps.push_back(step);
    held_out_.push_back({{}, holdout_errors.errors, holdout_errors.row});
  }

  std::vector<Outlier> find_gross_error_rows(const Estimate& geometry) const {
    std::vector<Outlier> gross_errors = without_explained_rows(geometry.outliers, current_.fit, rows_, rows_);
    for (const Outlier& outlier : gross_errors_of_both_models(geometry, current_.fit, rows_))
      if (!contains_row(gross_errors, outlier.row)) gross_errors.push_back(outlier);
    return gross_errors;
  }

  HoldoutErrors holdout_errors_of(const CandidateModel& tried, const ParameterSet& set,
                                  const std::vector<Split>& splits) const {
    return cross_validate(tried.fit, set, rows_, splits, task_, threads_);
  }

  /// Extrapolation is tested only where interpolation improves.
  void decide_on(SelectionStep& step, CandidateModel& next, const ParameterSet& set) const {
    step.interpolation = compare(current_, next, &CandidateModel::interpolation);
    if (decide_by_interpolation(step.interpolation, geometry_worst_) == Decision::accepted) {
      next.extrapolation = holdout_errors_of(next, set, extrapolation_splits_);
      step.extrapolation = compare(current_, next, &CandidateModel::extrapolation);
    }
    step.decision = decide(step.interpolation, step.extrapolation, geometry_worst_);
  }

  void test_term(Term term) {
    const ModelTerm model_term = make_model_term(term, current_.fit.chain, {task_.tolerances, rows_, current_.fit});
    SelectionStep step{.term = term,
                       .decision = Decision::requested,
                       .missing = model_term.missing,
                       .parameter_count = static_cast<int>(model_term.parameters.size()),
                       .masses_approximate = model_term.masses_approximate};
    if (model_term.missing != MissingData::none) {
      step.decision = Decision::data_missing;
      add(step, {});
      return;
    }
    ParameterSet set = current_.fit.parameters;
    set.parameters.insert(set.parameters.end(), model_term.parameters.begin(), model_term.parameters.end());
    CandidateModel next;
    next.fit = fit_rows(model_term.nominal, set, rows_, task_, {.detail = Detail::numbers_only}, observer_);
    count_determined(step, model_term, next.fit);
    if (step.determined_count == 0 && !fixed_) {
      step.decision = Decision::not_excited;
      add(step, {});
      return;
    }
    next.interpolation = holdout_errors_of(next, set, splits_);
    step.train = training_statistics(next, rows_);
    if (!fixed_) decide_on(step, next, set);
    add(step, next.interpolation);
    if (is_selected(step)) current_ = std::move(next);
  }

  const CalibrationTask& task_;
  const PoseSet& rows_;
  const std::vector<Split>& splits_;
  std::vector<Split> extrapolation_splits_;
  const FixedModel* fixed_;  // null: all terms are tested
  int threads_;
  const Observer& observer_;
  CandidateModel current_;
  ModelSelection selection_;
  std::vector<HoldoutErrors> held_out_;  // errors of each tested model
  double geometry_worst_ = 0.0;
};

}  // namespace

SelectedModel select_model(const CalibrationTask& task, const PoseSet& rows, const Estimate& geometry,
                           const std::vector<Split>& splits, const ModelChoice& model, int threads,
                           const Observer& observer) {
  return ModelSelector(task, rows, splits, model, threads, observer).run(geometry);
}

}  // namespace kinfer::calibrate
