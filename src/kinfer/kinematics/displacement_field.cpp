// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/displacement_field.hpp"

#include <algorithm>
#include <vector>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {

VectorXd kernel_at(const DisplacementField& field, ConstVectorRef q) {
  VectorXd value(field.points.cols());
  for (Eigen::Index k = 0; k < value.size(); ++k)
    value[k] = -0.5 * ((q - field.points.col(k)).array() / field.length.array()).square().sum();
  return value.array().exp();
}

FieldRoots roots_of(const DisplacementField& field) {
  constexpr double least_eigenvalue = 1e-6;  // of the largest: repeated and very near points add nothing
  if (field.empty()) return {};
  MatrixXd covariance(field.points.cols(), field.points.cols());
  for (Eigen::Index k = 0; k < covariance.cols(); ++k) covariance.col(k) = kernel_at(field, field.points.col(k));
  const SymmetricEigen eigen = symmetric_eigen(covariance);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < eigen.values.size(); ++k)
    if (eigen.values[k] > least_eigenvalue * eigen.values.maxCoeff()) kept.push_back(k);
  const MatrixXd vectors = eigen.vectors(Eigen::all, kept);
  const VectorXd roots = eigen.values(kept).cwiseSqrt();
  return {vectors * roots.asDiagonal(), vectors * roots.cwiseInverse().asDiagonal()};
}

double displacement_variance(const DisplacementField& field, const FieldRoots& roots, ConstVectorRef q) {
  if (field.empty()) return 0.0;
  const double known = (roots.inverse_root.transpose() * kernel_at(field, q)).squaredNorm();
  return field.size * field.size * std::max(0.0, 1.0 - known);
}

Eigen::Vector3d displacement_at(const DisplacementField& field, ConstVectorRef q) {
  if (field.empty()) return Eigen::Vector3d::Zero();
  return field.coefficients * kernel_at(field, q);
}

Eigen::Matrix3Xd displacement_slope(const DisplacementField& field, ConstVectorRef q) {
  Eigen::Matrix3Xd slope = Eigen::Matrix3Xd::Zero(3, q.size());
  if (field.empty()) return slope;
  const VectorXd value = kernel_at(field, q);
  for (Eigen::Index k = 0; k < value.size(); ++k)
    slope -= value[k] * field.coefficients.col(k) *
             ((q - field.points.col(k)).array() / field.length.array().square()).matrix().transpose();
  return slope;
}

}  // namespace kinfer
