// SPDX-License-Identifier: Apache-2.0
// Verification: whether an earlier calibration is still valid on new measurements.
#pragma once

#include <optional>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/calibration/prediction_model.hpp"
#include "kinfer/evidence/deployment/verification.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::deploy {

/// Valid: the rms error is within three times what the instrument's noise and the uncertainty of the calibration make
/// one expect at these poses. An instrument that is not stated is taken to be as noisy as in the calibration, which
/// `prediction` knows; without that, valid when refitting base and tool does not halve the error.
Result<Verification> verify(const Chain& chain, const Tolerances& tolerances,
                            const std::optional<Instrument>& instrument, const PoseSet& data,
                            const std::optional<PredictionModel>& prediction = std::nullopt);

}  // namespace kinfer::deploy
