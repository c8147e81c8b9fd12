// SPDX-License-Identifier: Apache-2.0
// Model selection: geometry, and the non-geometric terms that the marginal likelihood supports and held-out errors do
// not speak against.
//
// Extrapolation is tested on the ends of the joint space along its principal directions, each predicted from the rest.
// Farther out no data of one region tell, so a second model without the terms that only interpolate holds there.
#pragma once

#include <optional>

#include "kinfer/base/observer.hpp"
#include "kinfer/calibrate/problem/options.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"
#include "kinfer/measurement/split.hpp"

namespace kinfer::calibrate {

struct SelectedModel {
  Estimate fit;                      ///< of the selected model to all rows
  std::vector<Estimate> split_fits;  ///< one per split: the selected model fitted to the split's training rows
  ModelSelection model_selection;
  std::optional<Estimate> beyond;     ///< the model to trust far from the rows; none: `fit`
  std::vector<Outlier> gross_errors;  ///< rows with gross errors, excluded from the evaluation of every model
};

/// Starts from `geometry`, the fit to all `rows`; `splits` are of these rows. AutomaticModel tests every term,
/// FixedModel takes exactly its own, regardless of the held-out errors.
SelectedModel select_model(const CalibrationTask& task, const PoseSet& rows, const Estimate& geometry,
                           const std::vector<Split>& splits, const ModelChoice& model, int threads,
                           const Observer& observer = {});

}  // namespace kinfer::calibrate
