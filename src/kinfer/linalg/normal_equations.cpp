#include "kinfer/linalg/normal_equations.hpp"

#include <Eigen/Cholesky>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr double least_pivot_ratio = 1e-11;  // of aᵀa; below, fewer than five digits of the weakest direction are left
constexpr double unseen_square = 1e-14;      // of the largest eigenvalue of aᵀa, likewise
constexpr double unseen = 1e-13;             // of the largest singular value; what rounding makes of a zero

}  // namespace

NormalEquations normal_equations(ConstMatrixRef a, ConstVectorRef b) {
  KINFER_EXPECT(a.rows() == b.size(), "{} rows, {} values", a.rows(), b.size());
  NormalEquations equations{MatrixXd::Zero(a.cols(), a.cols()), a.transpose() * b};
  equations.matrix.selfadjointView<Eigen::Lower>().rankUpdate(a.transpose());
  return equations;
}

std::optional<VectorXd> damped_by_cholesky(const NormalEquations& equations, double damping) {
  MatrixXd matrix = equations.matrix;
  matrix.diagonal().array() += damping;
  const Eigen::LLT<MatrixXd> factor(matrix);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const auto pivots = factor.matrixLLT().diagonal();
  const double ratio = pivots.minCoeff() / pivots.maxCoeff();
  if (!(ratio * ratio >= least_pivot_ratio)) return std::nullopt;
  return VectorXd(factor.solve(-equations.gradient));
}

VectorXd damped_by_eigenvalues(const NormalEquations& equations, double damping) {
  const SymmetricEigen eigen = symmetric_eigen(equations.matrix);
  const VectorXd image = eigen.vectors.transpose() * equations.gradient;
  VectorXd along = VectorXd::Zero(image.size());
  for (Eigen::Index i = 0; i < along.size(); ++i)
    if (eigen.values[i] > unseen_square * eigen.values.maxCoeff()) along[i] = -image[i] / (eigen.values[i] + damping);
  return eigen.vectors * along;
}

SingularSystem singular_system(ConstMatrixRef a, ConstVectorRef b) {
  KINFER_EXPECT(a.rows() == b.size(), "{} rows, {} values", a.rows(), b.size());
  MatrixXd both(a.rows(), a.cols() + 1);
  both << a, b;
  const MatrixXd r = triangular_factor(both);  // its last column is qᵀb
  const Svd factors = svd(r.leftCols(a.cols()));
  return {factors.s, factors.v, factors.u.transpose() * r.col(a.cols())};
}

VectorXd damped_by_svd(const SingularSystem& system, double damping) {
  VectorXd along = VectorXd::Zero(system.s.size());
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    const double s = system.s[i];
    if (s > unseen * system.s[0]) along[i] = -s * system.image[i] / (s * s + damping);
  }
  return system.v * along;
}

}  // namespace kinfer
