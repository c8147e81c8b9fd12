// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/commanded_poses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "kinfer/calibrate/validation/thresholds.hpp"

namespace kinfer::calibrate {
namespace {

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

std::vector<int> commanded_poses(const MatrixXd& joints, const VectorXd& tolerance) {
  CommandedPoses known(joints, tolerance);
  std::vector<int> poses;
  int count = 0;
  for (int row = 0; row < joints.cols(); ++row) {
    int pose = known.find(row);
    if (pose < 0) known.add(pose = count++, row);
    poses.push_back(pose);
  }
  return poses;
}

std::vector<int> commanded_poses(const MatrixXd& joints) {
  return commanded_poses(joints, VectorXd::Constant(joints.rows(), thresholds::same_pose_angle));
}

}  // namespace kinfer::calibrate
