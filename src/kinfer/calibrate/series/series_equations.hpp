// SPDX-License-Identifier: Apache-2.0
// Normal equations of the free parameters of a chain and the coefficients of its series, without priors.
//
// Only four coefficients of a series act at one position, so the sums over the residuals cost little.
#pragma once

#include <vector>

#include "kinfer/calibrate/series/chain_series.hpp"
#include "kinfer/estimate/poses/pose_weights.hpp"

namespace kinfer::calibrate {

/// The unknown coefficients of one joint: those of the knots that act at some row.
struct SeriesBlock {
  int joint = 0, knots = 0;
  std::vector<Eigen::Index> unknown;  ///< of each knot; -1: none
  Eigen::Index begin = 0, count = 0;
};

/// Measurements to which series are fitted.
struct SeriesData {
  const PoseSet& rows;
  const Weights& weights;
  int threads = 1;
};

/// About the chain without its series: the unknowns are steps of the parameters, then the coefficients themselves.
struct SeriesSystem {
  std::vector<SeriesBlock> blocks;
  MatrixXd matrix;  ///< lower half
  VectorXd gradient;
  double squares = 0.0;
  Eigen::Index residuals = 0;
};

SeriesSystem make_system(const DetachedSeries& apart, const SeriesData& data);

}  // namespace kinfer::calibrate
