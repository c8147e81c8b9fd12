// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/moving_points.hpp"

#include <cmath>

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"
#include "kinfer/calibrate/diagnosis/thresholds.hpp"
#include "kinfer/estimate/poses/pose_uncertainty.hpp"

namespace kinfer::calibrate {

double spread_of(const std::vector<Vec3>& points) {
  const auto n = static_cast<double>(points.size());
  Vec3 centre = Vec3::Zero();
  for (const Vec3& point : points) centre += point / n;
  double squares = 0.0;
  for (const Vec3& point : points) squares += (point - centre).squaredNorm();
  return std::sqrt(squares / n);
}

double spread_of(const std::vector<PointMeasurement>& points) {
  std::vector<Vec3> positions;
  for (const PointMeasurement& point : points) positions.push_back(point.position);
  return spread_of(positions);
}

Result<void> expect_moving_points(const CalibrationTask& task) {
  const PoseSet& data = task.data;
  if (data.points.size() < thresholds::min_points_of_quick_fit || !data.mounting.empty()) return {};
  const std::vector<Pose> poses = predicted_poses(task.nominal, std::nullopt, data);
  std::vector<Vec3> predicted;
  for (const PointMeasurement& point : data.points)
    predicted.push_back(poses[static_cast<std::size_t>(point.row)] *
                        (point.target < 0 ? Vec3::Zero().eval() : Vec3(task.nominal.targets[point.target].xyz)));
  const double moves = spread_of(predicted), measured = spread_of(data.points);
  if (measured > thresholds::still_points * moves || moves < max_plausible_error(task)) return {};
  return error(
      "the measured points never move (by {:.3g} mm), although the joints move the tool by {:.3g} mm: the columns "
      "repeat one value",
      1e3 * measured, 1e3 * moves);
}

}  // namespace kinfer::calibrate
