// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/products.hpp"

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/normal_equations.hpp"

namespace kinfer {

MatrixXd product(ConstMatrixRef a, ConstMatrixRef b) {
  KINFER_EXPECT(a.cols() == b.rows(), "{} columns, {} rows", a.cols(), b.rows());
  return a * b;
}

MatrixXd transposed_times(ConstMatrixRef a, ConstMatrixRef b) {
  KINFER_EXPECT(a.rows() == b.rows(), "{} and {} rows", a.rows(), b.rows());
  return a.transpose() * b;
}

MatrixXd times_transposed(ConstMatrixRef a, ConstMatrixRef b) {
  KINFER_EXPECT(a.cols() == b.cols(), "{} and {} columns", a.cols(), b.cols());
  return a * b.transpose();
}

MatrixXd gram(ConstMatrixRef a) {
  constexpr Eigen::Index tall = 64;  // rows from which the kernel for normal equations is faster
  if (a.rows() < tall) return transposed_times(a, a);
  const NormalEquations equations = normal_equations(a, VectorXd::Zero(a.rows()));
  return equations.matrix.selfadjointView<Eigen::Lower>();
}

MatrixXd propagated_covariance(ConstMatrixRef jacobian, ConstMatrixRef covariance) {
  return times_transposed(product(jacobian, covariance), jacobian);
}

}  // namespace kinfer
