// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/decompositions.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer {

Svd svd(ConstMatrixRef a) {
  const Eigen::JacobiSVD<MatrixXd> decomposition(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {decomposition.matrixU(), decomposition.singularValues(), decomposition.matrixV()};
}

RightSvd right_svd(ConstMatrixRef a) {
  MatrixXd square = MatrixXd::Zero(a.cols(), a.cols());
  const MatrixXd r = triangular_factor(a);
  square.topRows(r.rows()) = r;
  const Eigen::JacobiSVD<MatrixXd> decomposition(square, Eigen::ComputeFullV);
  return {decomposition.singularValues(), decomposition.matrixV()};
}

SymmetricEigen symmetric_eigen(ConstMatrixRef a) {
  KINFER_EXPECT(a.rows() == a.cols(), "{} x {}", a.rows(), a.cols());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<VectorXd> solve_spd(ConstMatrixRef a, ConstVectorRef b) {
  const Eigen::LLT<MatrixXd> factor(a);
  if (factor.info() != Eigen::Success) return std::nullopt;
  return VectorXd(factor.solve(b));
}

MatrixXd solve_semidefinite(ConstMatrixRef a, ConstMatrixRef b) {
  return a.ldlt().solve(b);
}

std::optional<MatrixXd> invert_spd(ConstMatrixRef a) {
  const Eigen::LLT<MatrixXd> factor(a);
  if (factor.info() != Eigen::Success) return std::nullopt;
  return MatrixXd(factor.solve(MatrixXd::Identity(a.rows(), a.cols())));
}

std::optional<MatrixXd> cholesky(ConstMatrixRef a) {
  const Eigen::LLT<MatrixXd> factor(a);
  if (factor.info() != Eigen::Success) return std::nullopt;
  return MatrixXd(factor.matrixL());
}

VectorXd solve_least_squares(ConstMatrixRef a, ConstVectorRef b, double cut) {
  Eigen::JacobiSVD<MatrixXd> decomposition(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  decomposition.setThreshold(cut);
  return decomposition.solve(b);
}

MatrixXd triangular_factor(ConstMatrixRef a) {
  const Eigen::Index rows = std::min(a.rows(), a.cols());
  const Eigen::HouseholderQR<MatrixXd> factor(a);
  return factor.matrixQR().topRows(rows).template triangularView<Eigen::Upper>();
}

}  // namespace kinfer
