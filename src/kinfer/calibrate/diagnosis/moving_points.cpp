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

namespace {

/// Likewise of distances from anchors, which a tool on a circle about its anchor keeps.
Result<void> expect_changing_distances(const CalibrationTask& task, const std::vector<Pose>& poses) {
  double measured = 0.0, predicted = 0.0;
  const Pose base = task.nominal.base.pose();
  for (std::size_t anchor = 0; anchor < task.nominal.fixtures.anchors.size(); ++anchor) {
    std::vector<Vec3> lengths, by_model;
    for (const DistanceMeasurement& at : task.data.distances)
      if (static_cast<std::size_t>(at.anchor) == anchor) {
        lengths.emplace_back(at.distance, 0.0, 0.0);
        by_model.emplace_back(
            (poses[static_cast<std::size_t>(at.row)].position - base * task.nominal.fixtures.anchors[anchor]).norm(),
            0.0, 0.0);
      }
    if (lengths.size() < thresholds::min_points_of_quick_fit) return {};
    measured = std::max(measured, spread_of(lengths)), predicted = std::max(predicted, spread_of(by_model));
  }
  if (measured > thresholds::still_points * predicted || predicted < max_plausible_error(task)) return {};
  return error(
      "the measured distances never change (by {:.3g} mm), although the joints change them by {:.3g} mm: the columns "
      "repeat one value",
      1e3 * measured, 1e3 * predicted);
}

}  // namespace

Result<void> expect_moving_points(const CalibrationTask& task) {
  const PoseSet& data = task.data;
  if (!data.mounting.empty()) return {};
  const std::vector<Pose> poses = predicted_poses(task.nominal, std::nullopt, data);
  if (data.points.size() < thresholds::min_points_of_quick_fit)
    return data.points.empty() && !data.distances.empty() ? expect_changing_distances(task, poses) : Result<void>{};
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
