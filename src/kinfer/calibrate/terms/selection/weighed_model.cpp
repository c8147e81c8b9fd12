// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/selection/weighed_model.hpp"

#include "kinfer/calibrate/terms/decision.hpp"
#include "kinfer/calibrate/terms/selection/lines_or_series.hpp"
#include "kinfer/calibrate/terms/selection/model_weigher.hpp"
#include "kinfer/calibrate/terms/selection/weighed_field.hpp"

namespace kinfer::calibrate {
namespace {

/// Whether held-out errors are lower with the other model, and none of their points speaks against it.
bool is_better(const WeighedModel& other, const WeighedModel& present, const SelectionData& data,
               const std::vector<Split>& beyond) {
  const auto errors_beyond = [&](const WeighedModel& model) {
    return cross_validate(model.fit, model.fit.parameters, data.rows, beyond, data.task, data.threads);
  };
  const ErrorChange inside =
      compare_holdout(present.interpolation, present.fit.outliers, other.interpolation, other.fit.outliers);
  const ErrorChange outside =
      compare_holdout(errors_beyond(present), present.fit.outliers, errors_beyond(other), other.fit.outliers);
  return inside.t > 0.0 && decide(inside, outside) == Decision::accepted;
}

}  // namespace

WeighedModel weigh_model(const SelectionData& data, const Estimate& geometry) {
  std::vector<WeighedModel> models = weigh_terms(data, geometry);
  const std::vector<Split> beyond = splits_beyond(data.rows);
  for (WeighedModel& model : models) weigh_field(data, beyond, model);
  WeighedModel& best = models.front();
  for (const WeighedModel& other : models)
    if (!other.fit.chain.field.empty() && best.fit.chain.field.empty() && is_better(other, best, data, beyond))
      best = other;
  return best;
}

}  // namespace kinfer::calibrate
