// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/conclusion/least_motion.hpp"

#include <algorithm>

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"
#include "kinfer/calibrate/diagnosis/moving_points.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

/// Each joint's positions, moved on by another number of rows.
MatrixXd independent_joints(const MatrixXd& joints) {
  MatrixXd mixed(joints.rows(), joints.cols());
  for (Index k = 0; k < joints.rows(); ++k)
    for (Index row = 0; row < joints.cols(); ++row)
      mixed(k, row) = joints(k, (row + k * joints.cols() / joints.rows()) % joints.cols());
  return mixed;
}

Vec3 tool_deviations(const Chain& chain, const PoseSet& rows) {
  std::vector<Vec3> points;
  for (const Pose& pose : evaluate_poses(chain, {}, rows, Derivative::no).pose) points.push_back(pose.position);
  return principal_spread(points);
}

}  // namespace

double least_motion(const CalibrationTask& task, const Chain& nominal, const Chain& corrected) {
  PoseSet rows;
  rows.joints = independent_joints(task.data.joints);
  const Vec3 before = tool_deviations(nominal, rows), after = tool_deviations(corrected, rows);
  const double feigned = max_plausible_error(task);
  double least = 1.0;
  for (int k = 0; k < 3; ++k)
    if (before[k] > feigned) least = std::min(least, after[k] / before[k]);
  return least;
}

}  // namespace kinfer::calibrate
