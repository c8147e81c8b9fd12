// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/extrapolation_splits.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/measurement/commanded_poses.hpp"

namespace kinfer::calibrate {
namespace {

/// Joint positions minus their mean, scaled to unit norm; zero for joints that do not move.
MatrixXd standardised(const MatrixXd& joints) {
  MatrixXd z = joints.colwise() - joints.rowwise().mean();
  for (Eigen::Index k = 0; k < z.rows(); ++k) {
    const double spread = z.row(k).norm();
    z.row(k) *= spread > 1e-9 ? 1.0 / spread : 0.0;
  }
  return z;
}

/// Rows of one pose have the place of its first row, so that they stay on one side.
VectorXd same_within_poses(VectorXd along, const std::vector<int>& pose) {
  std::map<int, double> first;
  for (std::size_t row = 0; row < pose.size(); ++row) {
    double& place = along[static_cast<Eigen::Index>(row)];
    place = first.try_emplace(pose[row], place).first->second;
  }
  return along;
}

Split without_end(const VectorXd& along, bool hold_out_upper) {
  const double part = thresholds::extrapolation_part;
  const double border = quantile({along.begin(), along.end()}, hold_out_upper ? 1.0 - part : part);
  Split split;
  for (int row = 0; row < along.size(); ++row)
    ((along[row] > border) == hold_out_upper ? split.holdout : split.train).push_back(row);
  return split;
}

std::vector<int> every_nth(const std::vector<int>& rows, std::size_t n) {
  std::vector<int> kept;
  for (std::size_t i = 0; i < rows.size(); i += n) kept.push_back(rows[i]);
  return kept;
}

}  // namespace

std::vector<Split> extrapolation_splits(const PoseSet& data, int fewest) {
  std::vector<Split> splits;
  const auto enough = static_cast<std::size_t>(fewest);
  if (distinct_poses(data) < 2 * enough) return splits;
  const MatrixXd z = standardised(data.joints);
  const SymmetricEigen directions = symmetric_eigen(times_transposed(z, z));
  const Eigen::Index dof = z.rows();
  for (Eigen::Index k = 0; k < std::min<Eigen::Index>(2, dof); ++k) {
    const VectorXd along = same_within_poses(z.transpose() * directions.vectors.col(dof - 1 - k), data.pose);
    for (const bool upper : {true, false})
      if (Split split = without_end(along, upper);
          distinct_poses(data, split.train) >= enough && !split.holdout.empty())
        splits.push_back(std::move(split));
  }
  return splits;
}

std::vector<Split> thinned(std::vector<Split> splits, std::size_t most) {
  for (Split& split : splits) {
    const std::size_t n = (split.train.size() + most - 1) / most;
    if (n > 1) split = {every_nth(split.train, n), every_nth(split.holdout, n)};
  }
  return splits;
}

}  // namespace kinfer::calibrate
