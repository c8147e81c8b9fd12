// Least squares of measured points by the batch kernels: no Jacobian is kept, and a fit of 50 poses takes tens of
// microseconds. For chains with a batch form (kinematics/batch_plan.hpp) and position measurements alone.
#pragma once

#include "kinfer/estimate/residuals.hpp"
#include "kinfer/kinematics/batch_points.hpp"

namespace kinfer {

/// True where nothing but points was measured, at one mounting, and the chain has a batch form: what the kernels take.
bool has_points_alone(const Chain& chain, const ParameterSet& set, const PoseSet& data);

/// True where some point's errors are independent along axes of its own, not the world's.
bool has_full_covariances(const PoseSet& data);

/// diag(1/sd) axesᵀ of each point: turns its error and the error's derivative into independent rows of unit variance.
std::vector<Mat3> whiteners(const PoseSet& data, const Weights& weights);
/// `rows`: 3 points x n.
void whiten(const std::vector<Mat3>& by, Eigen::Ref<MatrixXd> rows);

/// The measured points of a pose set, in its order.
PointTable point_table(const PoseSet& data);

/// 1 / standard deviation of each coordinate of each point (3 x points).
Eigen::Matrix3Xd inverse_sd(const Weights& weights);

/// Calibration starts near the optimum, where the first step may be nearly whole.
inline LeastSquaresOptions near_the_optimum() {
  return {.initial_damping = 1e-6};
}

/// Minimises Σ |weight · (measured − predicted)|² + |prior_rows · (x − nominal)|², the same cost as pose_residuals,
/// from `start`. `points` was made with the same set.
LeastSquaresOutcome fit_points(const BatchPoints& points, const ParameterSet& set, const BatchPoints::Weights& weights,
                               ConstVectorRef start, const LeastSquaresOptions& options = near_the_optimum(),
                               const Observer& observer = {});

}  // namespace kinfer
