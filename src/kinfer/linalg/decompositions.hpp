// SPDX-License-Identifier: Apache-2.0
// Dense decompositions behind plain functions: Eigen's templates are compiled once, here.
#pragma once

#include <optional>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// a = u diag(s) vᵀ, thin, singular values descending.
struct Svd {
  MatrixXd u;  ///< m x k, k = min(m, n)
  VectorXd s;  ///< k
  MatrixXd v;  ///< n x k
};
Svd svd(ConstMatrixRef a);

/// Singular values and right singular vectors only; tall matrices are reduced by QR first. v is n x n.
struct RightSvd {
  VectorXd s;  ///< n, descending; zeros where a has fewer rows than columns
  MatrixXd v;  ///< n x n
};
RightSvd right_svd(ConstMatrixRef a);

/// a = vectors diag(values) vectorsᵀ of a symmetric matrix (lower half read), values ascending.
struct SymmetricEigen {
  VectorXd values;
  MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(ConstMatrixRef a);

/// Solves a x = b for symmetric positive definite a (lower half read); nullopt if a is not.
std::optional<VectorXd> solve_spd(ConstMatrixRef a, ConstVectorRef b);

/// x with a x = b for a symmetric positive semidefinite (lower half read) whose range holds the columns of b.
MatrixXd solve_semidefinite(ConstMatrixRef a, ConstMatrixRef b);

/// a⁻¹ of a symmetric positive definite matrix; nullopt if it is not.
std::optional<MatrixXd> invert_spd(ConstMatrixRef a);

/// l with a = l lᵀ, lower triangular; nullopt if a is not positive definite.
std::optional<MatrixXd> cholesky(ConstMatrixRef a);

/// The same for a finite matrix that is positive definite but for rounding: where it is not, of the one with a diagonal
/// that is larger by as little as makes it so, relative to itself.
MatrixXd cholesky_but_for_rounding(ConstMatrixRef a);
MatrixXd invert_but_for_rounding(ConstMatrixRef a);  ///< a⁻¹, likewise

/// Least-squares solution of smallest norm; singular values below `cut` times the largest count as zero.
VectorXd solve_least_squares(ConstMatrixRef a, ConstVectorRef b, double cut = 1e-12);

/// Upper triangular r of a = q r, with min(m, n) rows.
MatrixXd triangular_factor(ConstMatrixRef a);

}  // namespace kinfer
