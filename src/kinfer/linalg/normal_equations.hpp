// SPDX-License-Identifier: Apache-2.0
// Damped linear least squares, min |a x + b|² + damping |x|²: by normal equations where they are accurate enough, else
// by singular values.
#pragma once

#include <optional>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// The normal equations (aᵀa) x = −aᵀb of min |a x + b|².
struct NormalEquations {
  MatrixXd matrix;    ///< aᵀa, n x n; only the lower half is filled, the upper is zero
  VectorXd gradient;  ///< aᵀb, n
};
NormalEquations normal_equations(ConstMatrixRef a, ConstVectorRef b);

/// Solves a x = b in place by Cholesky, for tens of unknowns faster than Eigen: the lower half of `a` becomes its
/// factor (the upper is not read), `b` becomes x. False, with `b` unchanged, if a pivot is not positive.
bool solve_in_place(MatrixXd& a, VectorXd& b);

/// Solves (aᵀa + damping I) x = −aᵀb by Cholesky; nullopt if the matrix is not positive definite or too badly
/// conditioned for an accurate x. The solution by singular values below still works then.
std::optional<VectorXd> solve_damped_by_cholesky(const NormalEquations& equations, double damping);

/// The same x from the eigenvalues of aᵀa; directions whose eigenvalue is below rounding get a zero step.
VectorXd solve_damped_by_eigenvalues(const NormalEquations& equations, double damping);

/// Covariance, the inverse of a normal matrix (lower half read) that is positive definite but for rounding. Where it is
/// not, directions that are determined by less than 1e-12 of what each parameter is, the others given, get that much: a
/// large variance, and not none; an unknown that appears nowhere gets 1e18.
MatrixXd covariance_of_normal_matrix(ConstMatrixRef normal);

/// a = u diag(s) vᵀ and uᵀb, for repeated solutions with different damping.
struct SingularSystem {
  VectorXd s;      ///< singular values, descending
  MatrixXd v;      ///< n x k
  VectorXd image;  ///< uᵀb, k
};
SingularSystem singular_system(ConstMatrixRef a, ConstVectorRef b);

/// The same x from the singular values; directions that only rounding makes visible (s below 1e-13 of the largest) get
/// a zero step.
VectorXd solve_damped_by_svd(const SingularSystem& system, double damping);

}  // namespace kinfer
