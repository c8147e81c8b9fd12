// The least-squares problem of a pose set by its cost and normal equations: rows are made chunk by chunk and forgotten,
// so that a Jacobian of thousands of poses never leaves the cache.
//
// The cost is that of pose_residuals with a robust loss on each measurement's block. Torques of gravity are those of
// the nominal chain throughout: the derivative is exact, and a fit in several rounds takes them anew each round.
#pragma once

#include "kinfer/estimate/residuals.hpp"

namespace kinfer {

struct BlockLoss {
  Loss loss = Loss::none;
  double scale = 1.0;  ///< [sigma] as LeastSquaresOptions::loss_scale
};

/// For one thread: the buffers are kept between calls. All arguments but the last must outlive the result.
NormalProblem pose_normal_problem(const Chain& nominal, const ParameterSet& set, const PoseSet& data,
                                  const Weights& weights, BlockLoss loss = {});

/// What the priors add to the normal equations: unknowns x unknowns.
MatrixXd prior_information(const ParameterSet& set);

}  // namespace kinfer
