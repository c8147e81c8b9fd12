// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/iso9283.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "kinfer/calibrate/validation/thresholds.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/estimate/poses/repeated_measurements.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/measurement/commanded_poses.hpp"

namespace kinfer::calibrate {
namespace {

/// The measured tool points of each row.
std::vector<std::vector<Vec3>> points_of_rows(const PoseSet& data) {
  std::vector<std::vector<Vec3>> points(data.rows());
  for (const PointMeasurement& point : data.points)
    if (point.target < 0) points[point.row].push_back(point.position);
  return points;
}

std::vector<int> rows_with_points(const std::vector<std::vector<Vec3>>& points) {
  std::vector<int> rows;
  for (std::size_t row = 0; row < points.size(); ++row)
    if (!points[row].empty()) rows.push_back(static_cast<int>(row));
  return rows;
}

/// Of these rows, each once: a copy of a measurement is no repetition.
std::vector<Vec3> distinct_points(const std::vector<int>& rows, const std::vector<std::vector<Vec3>>& points) {
  std::vector<Vec3> distinct;
  std::set<std::array<double, 3>> known;
  for (const int row : rows)
    for (const Vec3& point : points[row])
      if (known.insert({point.x(), point.y(), point.z()}).second) distinct.push_back(point);
  return distinct;
}

}  // namespace

std::vector<PoseAccuracy> evaluate_pose_accuracy(const Chain& before, const Chain& after, const PoseSet& data) {
  const std::vector<std::vector<Vec3>> points = points_of_rows(data);
  const EvaluatedPoses at_before = evaluate_poses(before, {}, data, Derivative::no),
                       at_after = evaluate_poses(after, {}, data, Derivative::no);
  std::vector<PoseAccuracy> poses;
  const std::vector<int> state_of_row = states_of_rows(data, commanded_poses(data));
  std::map<int, std::size_t> place;
  for (const int row : rows_with_points(points)) {
    const auto [at, is_new] = place.try_emplace(state_of_row[static_cast<std::size_t>(row)], poses.size());
    if (is_new) poses.push_back({{}, 0.0, 0.0, {}});
    poses[at->second].rows.push_back(row);
  }
  for (PoseAccuracy& pose : poses) {
    const std::vector<Vec3> all = distinct_points(pose.rows, points);
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
