// SPDX-License-Identifier: Apache-2.0
// Normal equations of the free parameters of a chain and the coefficients of its series, without priors.
//
// Only four coefficients of a series act at one position, so the sums over the residuals cost little.
#pragma once

#include <vector>

#include "kinfer/calibrate/functions/beside_functions.hpp"
#include "kinfer/calibrate/functions/chain_series.hpp"

namespace kinfer::calibrate {

/// The unknown coefficients of one joint: those of the knots that act at some row.
struct SeriesBlock {
  int joint = 0, knots = 0;
  std::vector<Eigen::Index> unknown;  ///< of each knot; -1: none
  Eigen::Index begin = 0, count = 0;
};

/// About the chain without its series: the unknowns are steps of the parameters, then the coefficients themselves.
struct SeriesSystem {
  std::vector<SeriesBlock> blocks;
  MatrixXd matrix;  ///< lower half
  VectorXd gradient;
  double squares = 0.0;
  Eigen::Index residuals = 0;
};

SeriesSystem make_system(const DetachedSeries& apart, const WeightedRows& data);

}  // namespace kinfer::calibrate
