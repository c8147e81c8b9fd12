// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/iso9283.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/validation/thresholds.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::calibrate {
namespace {

/// Largest difference of each joint position within one commanded pose [rad], [m].
VectorXd command_tolerance(const Chain& chain) {
  const std::vector<int> moving = active_joints(chain);
  VectorXd tolerance(static_cast<Eigen::Index>(moving.size()));
  for (std::size_t k = 0; k < moving.size(); ++k)
    tolerance[static_cast<Eigen::Index>(k)] =
        translates(chain.joints[moving[k]].type) ? thresholds::same_pose_length : thresholds::same_pose_angle;
  return tolerance;
}

/// The measured tool points of each row.
std::vector<std::vector<Vec3>> points_of_rows(const PoseSet& data) {
  std::vector<std::vector<Vec3>> points(data.rows());
  for (const PointMeasurement& point : data.points)
    if (point.target < 0) points[point.row].push_back(point.position);
  return points;
}

Vec3 centroid(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

std::vector<PoseAccuracy> evaluate_pose_accuracy(const Chain& before, const Chain& after, const PoseSet& data) {
  const std::vector<std::vector<Vec3>> points = points_of_rows(data);
  const EvaluatedPoses at_before = evaluate_poses(before, {}, data, Derivative::no),
                       at_after = evaluate_poses(after, {}, data, Derivative::no);
  std::vector<PoseAccuracy> poses;
  const VectorXd tolerance = command_tolerance(after);
  const auto same_pose = [&](int a, int b) {
    for (Eigen::Index k = 0; k < tolerance.size(); ++k)
      if (!(std::abs(data.joints(k, a) - data.joints(k, b)) <= tolerance[k])) return false;
    return true;
  };
  for (int row = 0; row < data.rows(); ++row) {
    if (points[row].empty()) continue;
    const auto known =
        std::find_if(poses.begin(), poses.end(), [&](const PoseAccuracy& p) { return same_pose(p.rows.front(), row); });
    if (known == poses.end())
      poses.push_back({{row}, 0.0, 0.0, {}});
    else
      known->rows.push_back(row);
  }
  for (PoseAccuracy& pose : poses) {
    std::vector<Vec3> all;
    for (const int row : pose.rows) all.insert(all.end(), points[row].begin(), points[row].end());
    const Vec3 centre = centroid(all);
    pose.accuracy_before = (centre - at_before.pose[pose.rows.front()].position).norm();
    pose.accuracy_after = (centre - at_after.pose[pose.rows.front()].position).norm();
    if (all.size() < 2) continue;
    std::vector<double> distance;
    for (const Vec3& point : all) distance.push_back((point - centre).norm());
    pose.repeatability = mean(distance) + 3.0 * standard_deviation(distance);
  }
  return poses;
}

}  // namespace kinfer::calibrate
