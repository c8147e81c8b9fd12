// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/selection/weighed_geometry.hpp"

#include <algorithm>

#include "kinfer/calibrate/validation/gross_errors.hpp"
#include "kinfer/calibrate/validation/validation_errors.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {

void count_determined(SelectionStep& step, const std::string& parameter, const Estimate& fit) {
  const auto value = std::ranges::find(fit.values, parameter, &ParameterEstimate::name);
  if (value != fit.values.end() && value->identifiable)
    ++step.determined_count;
  else
    step.undetermined_parameters.push_back(parameter);
}

ErrorStatistics training_statistics(const Chain& chain, const std::vector<Outlier>& outliers, const PoseSet& rows) {
  const auto kind = primary_measurement_kind(rows);
  if (!kind) return {};
  const PoseSet inliers = select(rows, without_outliers(all_rows(rows), outliers));
  return error_statistics(position_errors_of_fit(*kind, chain, rows, inliers));
}

WeighedModel weighed_geometry(const SelectionData& data, const Estimate& geometry) {
  WeighedModel model{
      geometry, cross_validate(geometry, geometry.parameters, data.rows, data.splits, data.task, data.threads), {}};
  SelectionStep step{.decision = Decision::start};
  step.train = training_statistics(geometry.chain, geometry.outliers, data.rows);
  step.parameter_count = static_cast<int>(geometry.values.size());
  step.determined_count = geometry.identifiability.rank;
  model.steps.push_back({step, {{}, model.interpolation.errors, model.interpolation.row, model.interpolation.pose}});
  return model;
}

}  // namespace kinfer::calibrate
