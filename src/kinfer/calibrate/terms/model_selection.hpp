// SPDX-License-Identifier: Apache-2.0
// Forward model selection: geometry first, then each group of non-geometric terms that improves held-out errors.
//
// A group is accepted when the mean held-out error falls significantly, the largest held-out error does not rise, and
// the model does not extrapolate worse: it is fitted to one half of the poses, split along a principal direction of the
// joint positions, and evaluated on the other half. Terms that only interpolate would spoil poses outside the excited
// joint ranges. Training errors always fall and are not a criterion.
#pragma once

#include "kinfer/calibrate/validation/validation_errors.hpp"

namespace kinfer::calibrate {

struct SelectedModel {
  Estimate fit;                      ///< of the selected model to all rows
  std::vector<Estimate> split_fits;  ///< one per split: the selected model fitted to the split's training rows
  ModelSelection model_selection;
  std::vector<Outlier> gross_errors;  ///< rows with gross errors, excluded from the evaluation of every model
};

/// Starts from `geometry`, the fit to all `rows`; `splits` are of these rows. CrossValidatedModel tests every group of
/// terms, FixedModel takes exactly the named ones, regardless of the held-out errors.
SelectedModel select_model(const CalibrationTask& task, const PoseSet& rows, const Estimate& geometry,
                           const std::vector<Split>& splits, const CalibrationOptions& options,
                           const Observer& observer);

}  // namespace kinfer::calibrate
