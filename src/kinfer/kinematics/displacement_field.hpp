// SPDX-License-Identifier: Apache-2.0
// Displacement of the tool as a smooth function of all joint positions, of any form: what bearings, links and gears do
// together, and no other term has a name for.
//
// It is the mean of a Gaussian process with squared-exponential covariance (Rasmussen, Williams 2006, eq. 4.9), by its
// values at some joint positions, the inducing points (ibid. 8.3.2):
//   displacement(q) = Σ_k coefficient_k exp(−½ Σ_j ((q_j − point_kj) / length_j)²)
// Far from all points it is zero.
#pragma once

#include "kinfer/linalg/types.hpp"

namespace kinfer {

struct DisplacementField {
  MatrixXd points{};                ///< dof x m, the inducing points [rad] or [m]; no columns: there is no field
  VectorXd length{};                ///< dof, distance over which the displacement changes [rad] or [m], > 0
  Eigen::Matrix3Xd coefficients{};  ///< 3 x m, along the axes of the base [m]
  double size = 0.0;                ///< [m] standard deviation of each component before any measurement
  double noise = 0.0;  ///< [m] ([rad] of directions) of the measurements that it was found among; 0: unknown

  bool empty() const { return points.cols() == 0; }
};

/// exp(−½ Σ ((q − point) / length)²) of each inducing point, m.
VectorXd kernel_at(const DisplacementField& field, ConstVectorRef q);

/// Roots of the covariance K of the inducing points for a size of 1, without directions in which it is nearly singular:
/// K = root rootᵀ, K⁻¹ = inverse_root inverse_rootᵀ, m x rank.
struct FieldRoots {
  MatrixXd root, inverse_root;
};
FieldRoots roots_of(const DisplacementField& field);

/// [m²] of each component: what the values at the inducing points leave open, size² (1 − kᵀ K⁻¹ k). Zero at these
/// points, size² far from them, 0 without a field.
double displacement_variance(const DisplacementField& field, const FieldRoots& roots, ConstVectorRef q);

/// [m] along the axes of the base; zero without a field.
Eigen::Vector3d displacement_at(const DisplacementField& field, ConstVectorRef q);

/// Its derivative by the joint positions: 3 x dof [m/rad] or [m/m].
Eigen::Matrix3Xd displacement_slope(const DisplacementField& field, ConstVectorRef q);

}  // namespace kinfer
