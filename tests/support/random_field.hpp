// SPDX-License-Identifier: Apache-2.0
// A displacement field for tests.
#pragma once

#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/displacement_field.hpp"

namespace kinfer::test {

/// Of `points` inducing points within a radian of zero, some tenths of a millimetre large.
inline DisplacementField random_field(int dof, int points, Rng rng) {
  DisplacementField field{MatrixXd(dof, points), VectorXd(dof), Eigen::Matrix3Xd(3, points), 2e-4};
  for (double& q : field.points.reshaped()) q = rng.uniform(-1.0, 1.0);
  for (double& length : field.length) length = rng.uniform(0.5, 1.5);
  for (double& coefficient : field.coefficients.reshaped()) coefficient = 2e-4 * rng.normal();
  return field;
}

}  // namespace kinfer::test
