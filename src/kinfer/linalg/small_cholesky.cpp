// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/small_cholesky.hpp"

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

/// a = L D Lᵀ, in loops of known length that the compiler unrolls. c = L D.
bool solve_six(const Eigen::Matrix<double, 6, 6>& a, Eigen::Matrix<double, 6, 1>& b) {
  constexpr int n = 6;
  double l[n][n], c[n][n], inverse[n], x[n];
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) {
      c[i][j] = a(i, j);
      for (int k = 0; k < j; ++k) c[i][j] -= c[i][k] * l[j][k];
    }
    if (!(c[j][j] > 0.0)) return false;
    inverse[j] = 1.0 / c[j][j];
    for (int i = j + 1; i < n; ++i) l[i][j] = c[i][j] * inverse[j];
  }
  for (int i = 0; i < n; ++i) {
    x[i] = b[i];
    for (int k = 0; k < i; ++k) x[i] -= l[i][k] * x[k];
  }
  for (int i = n - 1; i >= 0; --i) {
    x[i] *= inverse[i];
    for (int k = i + 1; k < n; ++k) x[i] -= l[k][i] * x[k];
  }
  for (int i = 0; i < n; ++i) b[i] = x[i];
  return true;
}

}  // namespace kinfer
