// SPDX-License-Identifier: Apache-2.0
// Forward model selection: geometry first, then each group of non-geometric terms that improves held-out errors.
//
// Extrapolation is tested by fitting one half of the poses, split along a principal direction of the joint positions,
// and evaluating the other half: terms that only interpolate would spoil poses outside the excited joint ranges.
#pragma once

#include "kinfer/base/observer.hpp"
#include "kinfer/calibrate/problem/options.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"
#include "kinfer/measurement/split.hpp"

namespace kinfer::calibrate {

struct SelectedModel {
  Estimate fit;                      ///< of the selected model to all rows
  std::vector<Estimate> split_fits;  ///< one per split: the selected model fitted to the split's training rows
  ModelSelection model_selection;
  std::vector<Outlier> gross_errors;  ///< rows with gross errors, excluded from the evaluation of every model
};

/// Starts from `geometry`, the fit to all `rows`; `splits` are of these rows. AutomaticModel tests every term,
/// FixedModel takes exactly its own, regardless of the held-out errors.
SelectedModel select_model(const CalibrationTask& task, const PoseSet& rows, const Estimate& geometry,
                           const std::vector<Split>& splits, const ModelChoice& model, int threads,
                           const Observer& observer = {});

}  // namespace kinfer::calibrate
