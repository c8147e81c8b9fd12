// Damped linear least squares, min |a x + b|² + damping |x|²: normal equations where they are accurate,
// singular values where not.
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

/// x of (aᵀa + damping I) x = −aᵀb by Cholesky; nothing where the matrix is not positive definite or so badly
/// conditioned that few digits of x would be left. Then damped_by_svd still answers.
std::optional<VectorXd> damped_by_cholesky(const NormalEquations& equations, double damping);

/// The same x from the eigenvalues of aᵀa; directions whose eigenvalue is below rounding get no step at all.
VectorXd damped_by_eigenvalues(const NormalEquations& equations, double damping);

/// a = u diag(s) vᵀ as the damped problem needs it.
struct SingularSystem {
  VectorXd s;      ///< singular values, descending
  MatrixXd v;      ///< n x k
  VectorXd image;  ///< uᵀb, k
};
SingularSystem singular_system(ConstMatrixRef a, ConstVectorRef b);

/// The same x from the singular values; directions that a sees only by its rounding (s below 1e-13 of the largest) get
/// no step at all.
VectorXd damped_by_svd(const SingularSystem& system, double damping);

}  // namespace kinfer
