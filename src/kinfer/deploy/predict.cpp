// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/predict.hpp"

#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"

namespace kinfer::deploy {

Result<std::vector<Pose>> predict_poses(const Chain& chain, const PoseSet& rows) {
  KINFER_TRY(placed, calibrate::with_fixtures(chain, rows));
  return evaluate_poses(placed.chain, {}, with_approach(placed.data), Derivative::no).pose;
}

}  // namespace kinfer::deploy
