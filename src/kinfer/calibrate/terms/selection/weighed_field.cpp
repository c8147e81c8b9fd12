// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/selection/weighed_field.hpp"

#include <cmath>
#include <set>

#include "kinfer/calibrate/functions/chain_series.hpp"
#include "kinfer/calibrate/functions/displacement_fields.hpp"
#include "kinfer/calibrate/functions/thresholds.hpp"
#include "kinfer/calibrate/prediction/measured_region.hpp"
#include "kinfer/calibrate/terms/ablation.hpp"
#include "kinfer/calibrate/terms/decision.hpp"

namespace kinfer::calibrate {
namespace {

SelectionStep step_of(const FoundField& found) {
  // Residuals that are all zero (each socket touched once) tell nothing.
  if (!std::isfinite(found.log_evidence_gain))
    return {.term = Term::displacement_field, .decision = Decision::not_excited};
  return {.term = Term::displacement_field,
          .decision = Decision::no_evidence,
          .log_evidence_gain = found.log_evidence_gain,
          .parameter_count = found.values,
          .determined_count = found.determined};
}

FoundField field_beside(const SelectionData& data, const WeighedModel& model) {
  return find_field(model.fit, data.rows, data.task.instrument, data.threads);
}

/// The model with the field, and its held-out errors by the folds.
WeighedModel fitted_with(const SelectionData& data, const WeighedModel& model, const FoundField& found) {
  WeighedModel with = model;
  with.fit =
      fit_rows(found.chain, model.fit.parameters, data.rows, data.task,
               {.initial_guess = InitialGuess::near_optimum, .detail = Detail::numbers_only, .threads = data.threads},
               data.observer);
  with.interpolation = cross_validate(with.fit, with.fit.parameters, data.rows, data.splits, data.task, data.threads);
  // Far from the rows the field is gone, and the model without it holds.
  if (!with.beyond) with.beyond = model.fit;
  return with;
}

/// Errors of the model as it is used: outside of the rows of each split it fades to the one without the field. They
/// are at most the mean of both, by its weight.
HoldoutErrors faded(HoldoutErrors with, const HoldoutErrors& without, const PoseSet& rows,
                    const std::vector<Split>& splits) {
  std::size_t at = 0;
  for (const Split& split : splits) {
    PredictionModel region;
    describe_region(region, rows.joints(Eigen::all, split.train));
    const std::set<int> held_out(split.holdout.begin(), split.holdout.end());
    for (; at < with.row.size() && held_out.contains(with.row[at]); ++at) {
      const double weight = fading_weight(region, rows.joints.col(with.row[at]));
      with.errors[at] = weight * with.errors[at] + (1.0 - weight) * without.errors[at];
    }
  }
  return with;
}

WeighedStep describe(SelectionStep step, const WeighedModel& with, const SelectionData& data) {
  Chain plain = with.fit.chain;
  plain.field = {};
  step.train = training_statistics(with.fit.chain, with.fit.outliers, data.rows);
  step.contribution = rms_distance(with.fit.chain, plain, data.rows);
  return {step, {{}, with.interpolation.errors, with.interpolation.row, with.interpolation.pose}};
}

}  // namespace

void weigh_field(const SelectionData& data, const std::vector<Split>& extrapolation, WeighedModel& model) {
  SelectionStep step{.term = Term::displacement_field};
  // Of many rows series leave little: on UR10 a field lowers the held-out mean by 0.5 to 1.6 %, for twice the time.
  if (has_series(model.fit.chain) && data.rows.rows() > thresholds::field_rows) step.decision = Decision::superseded;
  if (!allows_field(data.rows)) step.decision = Decision::data_missing, step.missing = MissingData::points;
  if (step.decision != Decision::start) return model.steps.push_back({step, {}});
  const FoundField found = field_beside(data, model);
  step = step_of(found);
  if (!(found.log_evidence_gain > 0.0)) return model.steps.push_back({step, {}});
  WeighedModel with = fitted_with(data, model, found);
  const auto held_out = [&](const Estimate& fit) {
    return cross_validate(fit, fit.parameters, data.rows, extrapolation, data.task, data.threads);
  };
  step.interpolation = compare_holdout(model.interpolation, model.fit.outliers, with.interpolation, with.fit.outliers);
  const HoldoutErrors without = held_out(model.fit);
  step.extrapolation = compare_holdout(without, model.fit.outliers,
                                       faded(held_out(with.fit), without, data.rows, extrapolation), with.fit.outliers);
  step.decision = decide(step.interpolation, step.extrapolation);
  if (step.decision != Decision::accepted) return model.steps.push_back({step, {}});
  with.steps.push_back(describe(step, with, data));
  model = std::move(with);
}

void add_field(const SelectionData& data, WeighedModel& model) {
  SelectionStep step{
      .term = Term::displacement_field, .decision = Decision::data_missing, .missing = MissingData::points};
  if (!allows_field(data.rows)) return model.steps.push_back({step, {}});
  const FoundField found = field_beside(data, model);
  step = step_of(found);
  step.decision = Decision::requested;
  WeighedModel with = fitted_with(data, model, found);
  with.beyond = model.beyond;
  with.steps.push_back(describe(step, with, data));
  model = std::move(with);
}

}  // namespace kinfer::calibrate
