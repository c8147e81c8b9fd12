// SPDX-License-Identifier: Apache-2.0
// Uncertainty of the tool's pose that a calibrated chain predicts, from its prediction model.
#pragma once

#include <vector>

#include "kinfer/evidence/calibration/prediction_model.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Covariances along the axes of the world, of the model alone: without the noise of an instrument.
struct PoseUncertainty {
  Mat3 position = Mat3::Zero();  ///< [m²] of the tool point
  Mat3 rotation = Mat3::Zero();  ///< [rad²] of the tool's rotation vector
};

/// J Σ Jᵀ + growth · M at each row, in its mounting and under its loads. Parameters that the chain does not have (any
/// more) are left out.
std::vector<PoseUncertainty> pose_uncertainties(const Chain& chain, const PredictionModel& model, const PoseSet& rows);

/// Lower triangular L with covariance = L Lᵀ, of a covariance that may be singular.
MatrixXd covariance_root(ConstMatrixRef covariance);

}  // namespace kinfer
