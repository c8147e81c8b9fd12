// One fit of a robot to rows: frames from the data, priors, and the tolerances that the data believe.
#pragma once

#include "kinfer/calibrate/calibrate.hpp"

namespace kinfer {

/// How far the tolerances hold: 1 as given, larger where the nominal model is further off than they say.
struct ToleranceScale {
  double factor = 1.0;
};

/// What identifies the parameters of one fit: the start and the priors about it. Base and tool are found from the data
/// first (paper 2, section 2.2, does so by circles). Where they are not parameters themselves, those of the file are
/// kept as long as the data agree with its base to three tolerances.
struct PreparedFit {
  Chain start;
  ParameterSet parameters;
};
Result<PreparedFit> prepare_fit(const CalibrateTask& task, const PoseSet& rows, const ParameterChoice& choice,
                                ToleranceScale scale = {});

/// The nominal chain with base and tool fitted to the rows.
Result<Chain> fit_frames_only(const CalibrateTask& task, const PoseSet& rows);

/// Fits with the tolerances multiplied by `scale`.
Result<Estimate> fit_once(const CalibrateTask& task, const PoseSet& rows, const ParameterChoice& choice,
                          ToleranceScale scale, const Observer& observer = {});

struct ScaledFit {
  Estimate estimate;
  ToleranceScale scale;
};
/// Fits with the tolerances as given, and with larger ones where the residuals exceed the instrument by far; keeps what
/// the data believe by the marginal likelihood. Where the nominal model is very far off, several starts are tried.
Result<ScaledFit> fit_with_believable_tolerances(const CalibrateTask& task, const PoseSet& rows,
                                                 const ParameterChoice& choice, Rng rng, const Observer& observer = {});

}  // namespace kinfer
