// SPDX-License-Identifier: Apache-2.0
// Least-squares problem of a pose set by cost and normal equations: rows are computed and accumulated in chunks, so the
// Jacobian of thousands of poses stays in the cache.
//
// The cost is that of pose_residuals with a robust loss on each measurement's block. Gravity torques are those of the
// nominal chain throughout, so the derivative is exact; a fit in several rounds updates them each round.
#pragma once

#include "kinfer/estimate/poses/pose_residuals.hpp"

namespace kinfer {

struct BlockLoss {
  Loss loss = Loss::none;
  double scale = 1.0;  ///< [sigma] as LeastSquaresOptions::loss_scale
};

/// For use by one caller at a time: buffers are kept between calls. The first four arguments must outlive the result.
/// Up to `threads` threads (0: all cores) share the rows; the numbers do not depend on how many.
NormalProblem pose_normal_problem(const Chain& nominal, const ParameterSet& set, const PoseSet& data,
                                  const Weights& weights, BlockLoss loss = {}, int threads = 1);

/// Contribution of the priors to the normal matrix: unknowns x unknowns.
MatrixXd prior_information(const ParameterSet& set);

}  // namespace kinfer
