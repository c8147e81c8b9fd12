// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/small_cholesky.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace kinfer {

bool factorise_small(MatrixRef a) {
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    const double pivot = a(j, j) - a.row(j).head(j).squaredNorm();
    if (!(pivot > 0.0)) return false;
    a(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < a.rows(); ++i)
      a(i, j) = (a(i, j) - a.row(i).head(j).dot(a.row(j).head(j))) / a(j, j);
    a.col(j).head(j).setZero();
  }
  return true;
}

bool solve_six(const Eigen::Matrix<double, 6, 6>& a, Eigen::Matrix<double, 6, 1>& b) {
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> factor(a);
  if (factor.info() != Eigen::Success) return false;
  factor.solveInPlace(b);
  return true;
}

}  // namespace kinfer
