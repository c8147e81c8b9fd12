// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/functions/beside_functions.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer::calibrate {

std::vector<bool> inliers_of(const Estimate& fitted, const PoseSet& rows) {
  std::vector<bool> is_inlier;
  for (const Block& block : blocks_of(rows))
    is_inlier.push_back(std::ranges::find(fitted.outliers, block.row, &Outlier::row) == fitted.outliers.end());
  return is_inlier;
}

Estimate with_covariance(Estimate fit, const ParameterSet& set, const MatrixXd& covariance, const VectorXd& variances) {
  fit.parameters = set, fit.covariance = covariance, fit.covariance_beside_series.resize(0, 0);
  const VectorXd values = pack(set, fit.chain);
  for (std::size_t k = 0; k < fit.values.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    fit.values[k].value = values[i];
    fit.values[k].sd = std::sqrt(std::max(0.0, variances[i]));
  }
  return fit;
}

}  // namespace kinfer::calibrate
