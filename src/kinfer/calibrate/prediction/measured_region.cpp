// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/prediction/measured_region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kinfer/calibrate/prediction/thresholds.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {

using Eigen::Index;

MatrixXd representatives(const MatrixXd& joints) {
  return joints(Eigen::all, spread_indices(static_cast<int>(joints.cols()), thresholds::region_rows));
}

void describe_region(PredictionModel& model, const MatrixXd& joints) {
  const auto count = static_cast<int>(joints.cols());
  model.rows = representatives(joints);
  const MatrixXd centred = joints.colwise() - joints.rowwise().mean();
  model.spread = (centred.rowwise().squaredNorm() / std::max(1, count - 1)).cwiseSqrt().cwiseMax(1e-9);
  std::vector<double> distances, sides;
  for (Index row = 0; row < joints.cols(); row += std::max<Index>(1, joints.cols() / 300)) {
    // A representative is not its own neighbour.
    const VectorXd scale = model.spread.cwiseInverse();
    VectorXd squares =
        (scale.asDiagonal() * (model.rows.colwise() - VectorXd(joints.col(row)))).colwise().squaredNorm().transpose();
    for (double& s : squares)
      if (s == 0.0) s = std::numeric_limits<double>::infinity();
    if (const double least = squares.minCoeff(); std::isfinite(least)) distances.push_back(std::sqrt(least));
    sides.push_back(one_sidedness(model, joints.col(row)));
  }
  model.reach = distances.empty() ? 1.0 : quantile(std::move(distances), thresholds::region_part);
  const double side = sides.empty() ? 0.0 : quantile(std::move(sides), thresholds::region_part);
  model.edge = side > 0.0 && std::isfinite(side) ? thresholds::edge_over_measured * side : 1.0;
}

}  // namespace kinfer::calibrate
