// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/decompositions.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>
#include <utility>

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

MatrixXd cholesky_but_for_rounding(ConstMatrixRef a) {
  if (auto root = cholesky(a)) return std::move(*root);
  KINFER_EXPECT(a.allFinite(), "a matrix of {} rows is not finite", a.rows());
  // No diagonal is so small that a row divided by its root overflows: the loop ends.
  constexpr double smallest = std::numeric_limits<double>::epsilon() * std::numeric_limits<double>::epsilon();
  const double least = std::max(smallest * a.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  const VectorXd scale = a.diagonal().cwiseMax(least).cwiseSqrt();
  MatrixXd unit = scale.cwiseInverse().asDiagonal() * a * scale.cwiseInverse().asDiagonal();
  for (double more = 1e-14;; more *= 10.0) {  // at the latest when it outweighs all others of a row
    unit.diagonal().array() += more;
    if (const auto root = cholesky(unit)) return scale.asDiagonal() * *root;
  }
}

MatrixXd invert_but_for_rounding(ConstMatrixRef a) {
  if (auto inverse = invert_spd(a)) return std::move(*inverse);
  const MatrixXd root = cholesky_but_for_rounding(a);
  const MatrixXd inverse = root.triangularView<Eigen::Lower>().solve(MatrixXd::Identity(a.rows(), a.cols()));
  return inverse.transpose() * inverse;
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
