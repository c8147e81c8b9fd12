// SPDX-License-Identifier: Apache-2.0
// Linearised residuals of what is known of a machine at one time: external measurements, loop closures.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer {

/// The rows of one fact at one time, in units of its standard deviation.
struct InsFactRows {
  Eigen::Index interval = 0;
  VectorXd left;        ///< measured − predicted
  MatrixXd derivative;  ///< of the prediction: rows x (order · spline dimensions + global parameters); column
                        ///< i · dimensions + d is the i-th coefficient of dimension d in the interval
};

}  // namespace kinfer
