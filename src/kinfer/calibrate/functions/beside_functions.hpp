// SPDX-License-Identifier: Apache-2.0
// What fits of parameters beside functions of the joint positions (series, displacement fields) have in common.
#pragma once

#include <vector>

#include "kinfer/estimate/poses/bundle.hpp"

namespace kinfer::calibrate {

/// Measurements to which functions are fitted.
struct WeightedRows {
  const PoseSet& rows;
  const Weights& weights;
  int threads = 1;
};

/// One per block of the rows: whether its row is none of the outliers.
std::vector<bool> inliers_of(const Estimate& fitted, const PoseSet& rows);

/// A fit with the values of its chain for the parameters of `set`, this covariance, and these variances of the values:
/// those whatever the functions are.
Estimate with_covariance(Estimate fit, const ParameterSet& set, const MatrixXd& covariance, const VectorXd& variances);

}  // namespace kinfer::calibrate
