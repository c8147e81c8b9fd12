// SPDX-License-Identifier: Apache-2.0
// Joint positions that compensate the errors of a robot, and how well they reach their targets.
#pragma once

#include <vector>

#include "kinfer/kinematics/inverse.hpp"

namespace kinfer {

struct CompensatedJoints {
  VectorXd q{};                 ///< [rad] or [m]
  double residual = 0.0;        ///< [m] of the tool point, for the corrected chain
  double residual_angle = 0.0;  ///< [rad]
  InverseStatus status = InverseStatus::reached;
};

struct CompensationSummary {
  int rows = 0;
  std::vector<int> unreached{};  ///< rows that the inverse kinematics did not reach
  double worst_residual = 0.0;   ///< [m] over all rows
};
CompensationSummary summarise(const std::vector<CompensatedJoints>& rows);

}  // namespace kinfer
