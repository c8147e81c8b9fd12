// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/displacement_field.hpp"

namespace kinfer {

VectorXd kernel_at(const DisplacementField& field, ConstVectorRef q) {
  VectorXd value(field.points.cols());
  for (Eigen::Index k = 0; k < value.size(); ++k)
    value[k] = -0.5 * ((q - field.points.col(k)).array() / field.length.array()).square().sum();
  return value.array().exp();
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
