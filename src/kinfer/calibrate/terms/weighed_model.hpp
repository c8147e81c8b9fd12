// SPDX-License-Identifier: Apache-2.0
// Non-geometric terms that weigh themselves: one fit with all that the data could tell, the size of each group of
// parameters by the marginal likelihood, and the proof of the result by held-out errors.
#pragma once

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
};

/// The geometric model alone.
WeighedModel weighed_geometry(const SelectionData& data, const Estimate& geometry);

/// Geometry, and the terms that the marginal likelihood supports and the held-out errors do not speak against.
WeighedModel weigh_model(const SelectionData& data, const Estimate& geometry);

/// Counts a parameter that a step adds as determined by the fit, or lists it.
void count_determined(SelectionStep& step, const std::string& parameter, const Estimate& fit);

/// Errors of the fitted rows that are no outliers.
ErrorStatistics training_statistics(const Chain& chain, const std::vector<Outlier>& outliers, const PoseSet& rows);

}  // namespace kinfer::calibrate
