// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/normal_equations.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/aligned_buffer.hpp"
#include "kinfer/base/expect.hpp"
#include "kinfer/base/instruction_set.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/kernels/gram_jobs.hpp"

namespace kinfer {
namespace {

constexpr double min_pivot_ratio = 1e-11;  // of aᵀa; below, the weakest direction has fewer than five valid digits
constexpr double min_relative_eigenvalue = 1e-14;      // of the largest eigenvalue of aᵀa, likewise
constexpr double min_relative_singular_value = 1e-13;  // of the largest singular value; zero to rounding

/// Cholesky factor of a positive definite matrix in place, column by column, with four earlier columns at a time: for
/// tens of unknowns a third faster than Eigen's. False if a pivot is not positive.
bool factorise(MatrixXd& a) {
  const Eigen::Index n = a.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    double* to = a.col(k).data();
    Eigen::Index j = 0;
    for (; j + 4 <= k; j += 4) {
      const double *p = a.col(j).data(), *q = p + n, *r = q + n, *s = r + n;
      const double pk = p[k], qk = q[k], rk = r[k], sk = s[k];
      for (Eigen::Index i = k; i < n; ++i) to[i] -= (pk * p[i] + qk * q[i]) + (rk * r[i] + sk * s[i]);
    }
    for (; j < k; ++j) a.col(k).tail(n - k) -= a(k, j) * a.col(j).tail(n - k);
    if (!(to[k] > 0.0)) return false;
    to[k] = std::sqrt(to[k]);
    a.col(k).tail(n - k - 1) *= 1.0 / to[k];
  }
  return true;
}

/// Solves l lᵀ x = b in place.
void solve_factorised(const MatrixXd& l, VectorXd& b) {
  const Eigen::Index n = l.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    b[k] /= l(k, k);
    b.tail(n - k - 1) -= b[k] * l.col(k).tail(n - k - 1);
  }
  for (Eigen::Index k = n - 1; k >= 0; --k) b[k] = (b[k] - l.col(k).tail(n - k - 1).dot(b.tail(n - k - 1))) / l(k, k);
}

}  // namespace

const batch::GramKernel& batch::best_gram_kernel() {
#if defined(__x86_64__)
  if (instruction_set() == InstructionSet::avx512) return avx512_gram;
  if (instruction_set() == InstructionSet::avx2) return avx2_gram;
#endif
  return portable_gram;
}

NormalEquations normal_equations(ConstMatrixRef a, ConstVectorRef b) {
  KINFER_EXPECT(a.rows() == b.size(), "{} rows, {} values", a.rows(), b.size());
  NormalEquations equations{MatrixXd::Zero(a.cols(), a.cols()), VectorXd::Zero(a.cols())};
  if (a.size() == 0) return equations;
  const batch::GramKernel& kernel = batch::best_gram_kernel();
  const auto rows = static_cast<int>(a.rows()), columns = static_cast<int>(a.cols());
  batch::AlignedBuffer<double> workspace(batch::gram_workspace(rows, columns, kernel.lanes));
  kernel.normal_equations({.a = a.data(),
                           .a_stride = a.outerStride(),
                           .b = b.data(),
                           .rows = rows,
                           .columns = columns,
                           .matrix = equations.matrix.data(),
                           .gradient = equations.gradient.data(),
                           .workspace = workspace.data()});
  return equations;
}

bool solve_in_place(MatrixXd& a, VectorXd& b) {
  KINFER_EXPECT(a.rows() == a.cols() && a.rows() == b.size(), "{} x {}, {} values", a.rows(), a.cols(), b.size());
  if (!factorise(a)) return false;
  solve_factorised(a, b);
  return true;
}

std::optional<VectorXd> solve_damped_by_cholesky(const NormalEquations& equations, double damping) {
  MatrixXd matrix = equations.matrix;
  matrix.diagonal().array() += damping;
  if (!factorise(matrix)) return std::nullopt;
  const double ratio = matrix.diagonal().minCoeff() / matrix.diagonal().maxCoeff();
  if (!(ratio * ratio >= min_pivot_ratio)) return std::nullopt;
  VectorXd x = -equations.gradient;
  solve_factorised(matrix, x);
  return x;
}

VectorXd solve_damped_by_eigenvalues(const NormalEquations& equations, double damping) {
  const SymmetricEigen eigen = symmetric_eigen(equations.matrix);
  const VectorXd image = eigen.vectors.transpose() * equations.gradient;
  VectorXd along = VectorXd::Zero(image.size());
  for (Eigen::Index i = 0; i < along.size(); ++i)
    if (eigen.values[i] > min_relative_eigenvalue * eigen.values.maxCoeff())
      along[i] = -image[i] / (eigen.values[i] + damping);
  return eigen.vectors * along;
}

MatrixXd covariance_of_normal_matrix(ConstMatrixRef normal) {
  constexpr double least = 1e-12, least_information = 1e-9;
  // Scaled to unit diagonal before the inversion, for accuracy.
  const VectorXd scale = normal.diagonal().cwiseSqrt().cwiseMax(least_information).cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  // An unknown that appears nowhere leaves the others as they are.
  for (Eigen::Index k = 0; k < scaled.rows(); ++k)
    if (!(normal(k, k) > 0.0)) scaled(k, k) = 1.0;
  auto inverse = invert_spd(scaled);
  if (!inverse) {
    const SymmetricEigen eigen = symmetric_eigen(scaled);
    const VectorXd variances = eigen.values.cwiseMax(least).cwiseInverse();
    inverse = eigen.vectors * variances.asDiagonal() * eigen.vectors.transpose();
  }
  return scale.asDiagonal() * *inverse * scale.asDiagonal();
}

SingularSystem singular_system(ConstMatrixRef a, ConstVectorRef b) {
  KINFER_EXPECT(a.rows() == b.size(), "{} rows, {} values", a.rows(), b.size());
  MatrixXd both(a.rows(), a.cols() + 1);
  both << a, b;
  const MatrixXd r = triangular_factor(both);  // its last column is qᵀb
  const Svd factors = svd(r.leftCols(a.cols()));
  return {factors.s, factors.v, factors.u.transpose() * r.col(a.cols())};
}

VectorXd solve_damped_by_svd(const SingularSystem& system, double damping) {
  VectorXd along = VectorXd::Zero(system.s.size());
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    const double s = system.s[i];
    if (s > min_relative_singular_value * system.s[0]) along[i] = -s * system.image[i] / (s * s + damping);
  }
  return system.v * along;
}

}  // namespace kinfer
