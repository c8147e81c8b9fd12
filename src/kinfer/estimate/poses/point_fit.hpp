// SPDX-License-Identifier: Apache-2.0
// Least squares on measured points by the batch kernels: no Jacobian is stored, and a fit of 50 poses takes tens of
// microseconds. For chains with a batch form (kinematics) and position measurements only.
#pragma once

#include "kinfer/estimate/poses/pose_weights.hpp"
#include "kinfer/kinematics/batch/batch_points.hpp"
#include "kinfer/search/least_squares/least_squares.hpp"

namespace kinfer {

/// True if only points were measured, in one mounting, and the chain has a batch form, as the kernels require.
bool has_only_points(const Chain& chain, const ParameterSet& set, const PoseSet& data);

/// True if some point has a full covariance, that is principal axes other than the world's.
bool has_full_covariances(const PoseSet& data);

/// Whitening matrix diag(1/sd) axesᵀ of each point: maps its error and Jacobian to independent rows of unit variance.
std::vector<Mat3> whitening_matrices(const PoseSet& data, const Weights& weights);
/// `rows`: 3 points x n.
void whiten(const std::vector<Mat3>& by, Eigen::Ref<MatrixXd> rows);

/// The measured points of a pose set, in its order.
PointTable point_table(const PoseSet& data);

/// 1 / standard deviation of each coordinate of each point (3 x points).
Eigen::Matrix3Xd inverse_sd(const Weights& weights);

/// Little damping: calibration starts near the optimum, where a nearly full first step is right.
inline LeastSquaresOptions options_near_optimum() {
  return {.initial_damping = 1e-6};
}

/// Minimises Σ |weight · (measured − predicted)|² + |prior_sqrt_information_of · (x − nominal)|², the same cost as
/// pose_residuals, from `start`. `points` must be built from the same set.
LeastSquaresOutcome fit_points(const BatchPoints& points, const ParameterSet& set, const BatchPoints::Weights& weights,
                               ConstVectorRef start, const LeastSquaresOptions& options = options_near_optimum(),
                               const Observer& observer = {});

}  // namespace kinfer
