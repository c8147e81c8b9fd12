// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/selection/model_selection.hpp"

#include <algorithm>

#include "kinfer/calibrate/terms/candidate_terms.hpp"
#include "kinfer/calibrate/terms/holdout_errors.hpp"
#include "kinfer/calibrate/terms/selection/weighed_field.hpp"
#include "kinfer/calibrate/terms/selection/weighed_model.hpp"
#include "kinfer/calibrate/validation/gross_errors.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

/// Exactly the named terms, each with the prior that it has by itself.
WeighedModel fit_fixed_model(const SelectionData& data, const Estimate& geometry, const FixedModel& model) {
  WeighedModel fixed = weighed_geometry(data, geometry);
  for (const Term term : model.terms) {
    if (term == Term::displacement_field) continue;
    const std::vector<SpectralLine> lines = term == Term::spectral_harmonics
                                                ? find_gear_harmonics(fixed.fit, data.rows, data.threads)
                                                : std::vector<SpectralLine>{};
    ModelTerm model_term = make_model_term(term, fixed.fit.chain, {data.task.tolerances, data.rows, lines});
    SelectionStep step{.term = term,
                       .decision = Decision::requested,
                       .missing = model_term.missing,
                       .parameter_count = static_cast<int>(model_term.parameters.size()),
                       .masses_approximate = model_term.masses_approximate};
    HoldoutErrors held_out;
    if (model_term.missing != MissingData::none) {
      step.decision = Decision::data_missing;
    } else {
      remove_parts_of_series(model_term.parameters, model_term.nominal);
      const ParameterSet set = with_parameters(fixed.fit.parameters, model_term.parameters);
      fixed.fit = fit_rows(model_term.nominal, set, data.rows, data.task,
                           {.detail = Detail::numbers_only, .threads = data.threads}, data.observer);
      for (const Parameter& parameter : model_term.parameters) count_determined(step, parameter.name, fixed.fit);
      fixed.interpolation = cross_validate(fixed.fit, set, data.rows, data.splits, data.task, data.threads);
      step.train = training_statistics(fixed.fit.chain, fixed.fit.outliers, data.rows);
      held_out = {{}, fixed.interpolation.errors, fixed.interpolation.row, fixed.interpolation.pose};
    }
    fixed.steps.push_back({step, held_out});
  }
  if (std::ranges::count(model.terms, Term::displacement_field) > 0) add_field(data, fixed);
  return fixed;
}

std::vector<Outlier> find_gross_error_rows(const Estimate& geometry, const Estimate& selected, const PoseSet& rows) {
  std::vector<Outlier> gross_errors = without_explained_rows(geometry.outliers, selected, rows, rows);
  for (const Outlier& outlier : gross_errors_of_both_models(geometry, selected, rows))
    if (!contains_row(gross_errors, outlier.row)) gross_errors.push_back(outlier);
  return gross_errors;
}

}  // namespace

SelectedModel select_model(const CalibrationTask& task, const PoseSet& rows, const Estimate& geometry,
                           const std::vector<Split>& splits, const ModelChoice& model, int threads,
                           const Observer& observer) {
  const SelectionData data{task, rows, splits, threads, observer};
  const auto* fixed = std::get_if<FixedModel>(&model);
  WeighedModel selected = fixed ? fit_fixed_model(data, geometry, *fixed) : weigh_model(data, geometry);
  ModelSelection selection;
  for (const WeighedStep& step : selected.steps) selection.steps.push_back(step.step);
  if (!selected_terms(selection).empty())  // identifiability is computed for the selected model only
    selected.fit = fit_rows(selected.fit.chain, selected.fit.parameters, rows, task,
                            {.initial_guess = InitialGuess::near_optimum, .threads = threads});
  const std::vector<Outlier> gross_errors = find_gross_error_rows(geometry, selected.fit, rows);
  for (std::size_t i = 0; i < selection.steps.size(); ++i)
    selection.steps[i].holdout = statistics_without(selected.steps[i].held_out, gross_errors);
  return {selected.fit, selected.interpolation.split_fits, selection, selected.beyond, gross_errors};
}

}  // namespace kinfer::calibrate
