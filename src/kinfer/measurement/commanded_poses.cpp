// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/commanded_poses.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "kinfer/measurement/row_selection.hpp"

namespace kinfer {
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

/// [1] odds from which on rows are repeats and not neighbours by chance.
constexpr double repeat_odds = 1e3;
/// Distances are counted in steps of √2, from 2^-40 (rounding) of the scale on.
constexpr int finest = 40, steps = 2 * finest;  // to the scale itself: beyond it there need not be any rows
/// [steps] of the narrowest empty ring: rows on a path or a grid have neighbours at twice the least distance.
constexpr int narrowest_ring = 4;
constexpr double most_pairs = 3e7;  // that are compared; more: slower

/// The largest difference of a joint, squared.
double square_distance(const MatrixXd& scaled, Eigen::Index a, Eigen::Index b) {
  const double largest = (scaled.col(a) - scaled.col(b)).cwiseAbs().maxCoeff();
  return largest * largest;
}

/// Of a squared distance: its binary exponent, from 0.
int step_of(double square) {
  const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(square) >> 52) - 1023;
  return std::clamp(exponent + 2 * finest, 0, steps - 1);
}

double upper_limit_of(double step) {
  return std::exp2(0.5 * (step + 1.0) - finest);
}

/// How many other rows lie within each step of one row.
using Neighbours = std::array<int, steps>;

std::vector<Neighbours> neighbours_of_rows(const MatrixXd& scaled) {
  const auto rows = static_cast<int>(scaled.cols());
  const int most = std::max(50, static_cast<int>(most_pairs / std::max(1, rows)));
  std::vector<Neighbours> all;
  for (const int row : spread_indices(rows, most)) {
    Neighbours& within = all.emplace_back();
    for (int other = 0; other < rows; ++other)
      if (other != row) ++within[static_cast<std::size_t>(step_of(square_distance(scaled, row, other)))];
    std::partial_sum(within.begin(), within.end(), within.begin());
  }
  return all;
}

/// An empty ring about the rows of a pose: they lie within step `inner`, the next ones beyond step `outer`.
struct Ring {
  int inner = 0, outer = 0;
};

/// Of clusters with rows within the ring's outer step: log of the odds of two levels against one.
double log_odds_of_repeats(const std::vector<Neighbours>& rows, const Ring& ring, double rows_each) {
  double repeats = 0.0, others = 0.0;
  for (const Neighbours& within : rows) {
    const double inside = within[static_cast<std::size_t>(ring.inner)],
                 all = within[static_cast<std::size_t>(ring.outer)];
    (inside < all ? others : repeats) += all / (all + 1.0);  // each cluster of n rows counts n − 1 times
  }
  const double chance = std::exp2(0.5 * (ring.inner - ring.outer)), trials = repeats + others;
  if (!(repeats > chance * trials)) return 0.0;
  const double part = repeats / trials;
  const double of_others = others > 0.0 ? others * std::log((1.0 - part) / (1.0 - chance)) : 0.0;
  return rows_each * (repeats * std::log(part / chance) + of_others);
}

}  // namespace

double repeat_distance(const MatrixXd& joints, const VectorXd& scale) {
  const double rounding = upper_limit_of(0);
  if (joints.cols() < 2 || !(scale.size() > 0 && scale.maxCoeff() > 0.0)) return rounding;
  const VectorXd unit = (scale.array() > 0.0).select(scale.cwiseMax(1e-300).cwiseInverse(), 0.0);
  const MatrixXd scaled = unit.asDiagonal() * joints;
  const std::vector<Neighbours> rows = neighbours_of_rows(scaled);
  const double rows_each = static_cast<double>(joints.cols()) / static_cast<double>(rows.size());
  double best = std::log(repeat_odds), distance = rounding;
  for (int inner = 0; inner < steps; ++inner)
    for (int outer = inner + narrowest_ring; outer < steps; ++outer)
      if (const double odds = log_odds_of_repeats(rows, {inner, outer}, rows_each); odds > best)
        best = odds, distance = upper_limit_of(0.5 * (inner + outer));
  return distance;
}

std::vector<int> commanded_poses(const MatrixXd& joints, const VectorXd& scale) {
  const double within = repeat_distance(joints, scale);
  // A joint that does not move tells no rows apart.
  const VectorXd tolerance = (scale.array() > 0.0).select(within * scale, 1.0);
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

int pose_of_row(const PoseSet& data, int row) {
  return data.pose.empty() ? row : data.pose[static_cast<std::size_t>(row)];
}

std::size_t distinct_poses(const PoseSet& data, const std::vector<int>& rows) {
  std::set<int> distinct;
  for (const int row : rows) distinct.insert(pose_of_row(data, row));
  return distinct.size();
}

std::size_t distinct_poses(const PoseSet& data) {
  return distinct_poses(data, all_rows(data));
}

std::vector<int> commanded_poses(const PoseSet& data) {
  if (!data.pose.empty() || data.rows() == 0) return data.pose;
  return commanded_poses(data.joints, data.joints.rowwise().maxCoeff() - data.joints.rowwise().minCoeff());
}

}  // namespace kinfer
