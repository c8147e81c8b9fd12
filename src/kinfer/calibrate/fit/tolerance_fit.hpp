// SPDX-License-Identifier: Apache-2.0
// One least-squares fit of a robot to rows: initial frames from the data, priors, and the scale of the tolerances.
#pragma once

#include "kinfer/base/observer.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/calibrate/problem/options.hpp"
#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"

namespace kinfer::calibrate {

/// Whether anything measures a length. Contacts, planes and directions alone determine only ratios of lengths:
/// shrinking the robot would reduce the residuals, so the tolerances of lengths are not scaled without.
bool lengths_are_measured(const CalibrationTask& task);

/// Scale of the tolerances: 1 as given, larger where the errors of the nominal model exceed them.
struct ToleranceScale {
  double factor = 1.0;
};

/// The initial chain and the parameters with their priors. Base and tool are estimated from the data first (paper 2,
/// section 2.2, does so by circles). Where they are not parameters themselves, those of the file are kept if its base
/// agrees with the data within three tolerances.
struct PreparedFit {
  Chain start;
  ParameterSet parameters;
};
Result<PreparedFit> prepare_fit(const CalibrationTask& task, const PoseSet& rows, const ParameterChoice& choice,
                                ToleranceScale scale = {});

/// The nominal chain with base and tool fitted to the rows.
Result<Chain> fit_frames_only(const CalibrationTask& task, const PoseSet& rows);

/// Fits with the tolerances multiplied by `scale`.
Result<Estimate> fit_once(const CalibrationTask& task, const PoseSet& rows, const ParameterChoice& choice,
                          ToleranceScale scale, const Observer& observer = {}, int threads = 1);

struct ScaledFit {
  Estimate estimate;
  ToleranceScale scale;
};
/// Fits with the tolerances as given, and with larger ones where the residuals far exceed the instrument's noise; keeps
/// the fit with the highest marginal likelihood. Where the residuals stay large, random perturbed starts are tried too.
Result<ScaledFit> fit_with_scaled_tolerances(const CalibrationTask& task, const PoseSet& rows,
                                             const ParameterChoice& choice, Rng rng, const Observer& observer = {},
                                             int threads = 1);

}  // namespace kinfer::calibrate
