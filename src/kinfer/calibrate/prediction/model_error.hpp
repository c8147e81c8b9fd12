// SPDX-License-Identifier: Apache-2.0
// The model error: what the held-out residuals exceed the uncertainty of the parameters and the instrument's noise by.
//
// Its covariance has the shape of the mean excess, along the axes of the base, and the size with which 95 % of the
// held-out points lie within their 95 % ellipsoids (split conformal prediction: Vovk, Gammerman, Shafer 2005). What it
// gains outside the fitted region is set likewise on regions of the joint space that were not fitted.
#pragma once

#include <optional>

#include "kinfer/calibrate/validation/validation_errors.hpp"

namespace kinfer::calibrate {

struct HeldOutPrediction {
  PredictionModel model{};
  /// [m] rms error of the held-out tool points that the model predicts, with the instrument's noise: what its
  /// ellipsoids have room for. Nothing where there are too few of them for a model error.
  std::optional<double> holdout_rms{};
};

/// The prediction model of the final estimate; nothing where no points were measured. `beyond`: a fit to the same rows
/// without the terms that only interpolate, which holds far from them; none: the estimate holds everywhere.
std::optional<HeldOutPrediction> make_prediction_model(const EvaluationInputs& evaluated, const Estimate& estimate,
                                                       const std::optional<Estimate>& beyond, int threads);

}  // namespace kinfer::calibrate
