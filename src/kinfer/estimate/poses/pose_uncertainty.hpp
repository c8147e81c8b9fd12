// SPDX-License-Identifier: Apache-2.0
// The tool's pose that a calibrated chain predicts, and its uncertainty, from its prediction model.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/evidence/calibration/prediction_model.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Covariances along the axes of the world, of the model alone: without the noise of an instrument.
struct PoseUncertainty {
  Mat3 position = Mat3::Zero();  ///< [m²] of the tool point
  Mat3 rotation = Mat3::Zero();  ///< [rad²] of the tool's rotation vector
};

/// J Σ Jᵀ + model error + what a displacement field leaves open + what fading corrections leave open, at each row, in
/// its mounting and under its loads. Parameters that the chain does not have (any more) are left out.
std::vector<PoseUncertainty> pose_uncertainties(const Chain& chain, const PredictionModel& model, const PoseSet& rows,
                                                int threads = 1);

/// The chain with the parameters that hold where the corrections have this weight: 1 as given, 0 far from the fitted
/// rows, without a displacement field.
Chain chain_with_corrections(const Chain& chain, const PredictionModel& model, double weight);

/// The tool pose of each row, in its mounting and under its loads; corrections fade outside the measured region.
/// Without a prediction model they hold everywhere.
std::vector<Pose> predicted_poses(const Chain& chain, const std::optional<PredictionModel>& model, const PoseSet& rows);

/// A pose between that with all corrections and that without, by their weight w, and how far apart the two are, d: of a
/// mixture of both the covariance is w (1 − w) d dᵀ, and (1 − w) d is off where the corrections go on to hold.
struct PredictedPose {
  Pose pose;
  double weight = 1.0;                             ///< w
  Vec3 shift = Vec3::Zero(), turn = Vec3::Zero();  ///< d, [m] and [rad] along the axes of the world
};
std::vector<PredictedPose> predicted_with_spread(const Chain& chain, const std::optional<PredictionModel>& model,
                                                 const PoseSet& rows, int threads = 1);

/// Lower triangular L with covariance = L Lᵀ, of a covariance that may be singular.
MatrixXd covariance_root(ConstMatrixRef covariance);

}  // namespace kinfer
