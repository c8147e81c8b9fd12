// SPDX-License-Identifier: Apache-2.0
// Box constraints.
#pragma once

#include "kinfer/linalg/types.hpp"

namespace kinfer {

struct Bounds {
  VectorXd lower{}, upper{};  ///< of equal size, lower <= upper

  Eigen::Index size() const { return lower.size(); }
  VectorXd center() const { return 0.5 * (lower + upper); }
  VectorXd half_width() const { return 0.5 * (upper - lower); }
};

/// The columns of x, each clamped to the box.
inline MatrixXd clamped(ConstMatrixRef x, const Bounds& bounds) {
  return x.cwiseMax(bounds.lower.replicate(1, x.cols())).cwiseMin(bounds.upper.replicate(1, x.cols()));
}

}  // namespace kinfer
