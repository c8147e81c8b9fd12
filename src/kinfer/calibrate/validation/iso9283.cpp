// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/iso9283.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

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

/// Of these rows, each once: a copy of a measurement is no repetition.
std::vector<Vec3> distinct_points(const std::vector<int>& rows, const std::vector<std::vector<Vec3>>& points) {
  std::vector<Vec3> distinct;
  std::set<std::array<double, 3>> known;
  for (const int row : rows)
    for (const Vec3& point : points[row])
      if (known.insert({point.x(), point.y(), point.z()}).second) distinct.push_back(point);
  return distinct;
}

Vec3 centroid(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

/// Finds the commanded pose of a row among those before it. They are kept in cells of twice the tolerance, of the
/// joints with the largest ranges, so that a row is compared with those in the two nearest cells of each of these
/// joints: a million rows take seconds.
class CommandedPoses {
 public:
  CommandedPoses(const MatrixXd& joints, const VectorXd& tolerance) : joints_(joints), tolerance_(tolerance) {
    std::vector<Eigen::Index> order(static_cast<std::size_t>(tolerance.size()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    if (joints.cols() == 0) return;
    const auto range = [&](Eigen::Index k) {
      return (joints.row(k).maxCoeff() - joints.row(k).minCoeff()) / tolerance[k];
    };
    std::ranges::stable_sort(order, std::greater{}, range);
    if (order.size() > cell_joints) order.resize(cell_joints);
    in_cells_ = order;
  }

  /// The number of the first pose that `row` repeats; −1: of none.
  int find(int row) const {
    int first = -1;
    for (unsigned side = 0; side < (1u << in_cells_.size()); ++side) {
      const auto cell = cells_.find(cell_of(row, side));
      if (cell == cells_.end()) continue;
      for (const auto& [pose, representative] : cell->second)
        if ((first < 0 || pose < first) && is_same(representative, row)) first = pose;
    }
    return first;
  }

  void add(int pose, int row) { cells_[home_of(row)].push_back({pose, row}); }

 private:
  static constexpr std::size_t cell_joints = 4;
  using Cell = std::array<double, cell_joints>;  // whole numbers

  bool is_same(int a, int b) const {
    for (Eigen::Index k = 0; k < tolerance_.size(); ++k)
      if (!(std::abs(joints_(k, a) - joints_(k, b)) <= tolerance_[k])) return false;
    return true;
  }

  double place(int row, std::size_t k) const { return joints_(in_cells_[k], row) / (2.0 * tolerance_[in_cells_[k]]); }

  Cell home_of(int row) const {
    Cell cell{};
    for (std::size_t k = 0; k < in_cells_.size(); ++k) cell[k] = std::floor(place(row, k));
    return cell;
  }

  /// The cell of the row, or with bit k of `side` the neighbour that is nearer in joint k.
  Cell cell_of(int row, unsigned side) const {
    Cell cell = home_of(row);
    for (std::size_t k = 0; k < in_cells_.size(); ++k)
      if (side >> k & 1u) cell[k] += place(row, k) - cell[k] < 0.5 ? -1.0 : 1.0;
    return cell;
  }

  const MatrixXd& joints_;
  const VectorXd& tolerance_;
  std::vector<Eigen::Index> in_cells_;
  std::map<Cell, std::vector<std::pair<int, int>>> cells_;  // pose and its first row
};

}  // namespace

std::vector<PoseAccuracy> evaluate_pose_accuracy(const Chain& before, const Chain& after, const PoseSet& data) {
  const std::vector<std::vector<Vec3>> points = points_of_rows(data);
  const EvaluatedPoses at_before = evaluate_poses(before, {}, data, Derivative::no),
                       at_after = evaluate_poses(after, {}, data, Derivative::no);
  std::vector<PoseAccuracy> poses;
  const VectorXd tolerance = command_tolerance(after);
  CommandedPoses commanded(data.joints, tolerance);
  for (int row = 0; row < data.rows(); ++row) {
    if (points[row].empty()) continue;
    if (const int known = commanded.find(row); known >= 0) {
      poses[static_cast<std::size_t>(known)].rows.push_back(row);
    } else {
      commanded.add(static_cast<int>(poses.size()), row);
      poses.push_back({{row}, 0.0, 0.0, {}});
    }
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
