// SPDX-License-Identifier: Apache-2.0
// The geometric model alone, which every model selection starts from, and what the selection steps say of fits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/observer.hpp"
#include "kinfer/calibrate/terms/holdout_errors.hpp"

namespace kinfer::calibrate {

/// What every model is fitted to and proved by.
struct SelectionData {
  const CalibrationTask& task;
  const PoseSet& rows;
  const std::vector<Split>& splits;  ///< random folds of the rows
  int threads;
  const Observer& observer;
};

/// A step with the held-out errors of the model that has the terms up to it; empty where it is not selected.
struct WeighedStep {
  SelectionStep step;
  HoldoutErrors held_out;
};

struct WeighedModel {
  Estimate fit;                 ///< to all rows
  HoldoutErrors interpolation;  ///< by the splits
  std::vector<WeighedStep> steps;
  std::optional<Estimate> beyond{};  ///< the model to trust far from the rows; none: `fit`
};

/// The geometric model alone.
WeighedModel weighed_geometry(const SelectionData& data, const Estimate& geometry);

/// Counts a parameter that a step adds as determined by the fit, or lists it.
void count_determined(SelectionStep& step, const std::string& parameter, const Estimate& fit);

/// Errors of the fitted rows that are no outliers.
ErrorStatistics training_statistics(const Chain& chain, const std::vector<Outlier>& outliers, const PoseSet& rows);

}  // namespace kinfer::calibrate
