// SPDX-License-Identifier: Apache-2.0
// Which parameters differ between two calibrations of a robot.
#pragma once

#include <string>
#include <vector>

#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

struct ParameterChange {
  std::string name{};
  Quantity quantity = Quantity::length;
  double before = 0.0, after = 0.0, change = 0.0;  ///< [m], [rad], …; `change` of rx ry rz: the relative rotation
  double sd = 0.0;                                 ///< of the change
  double sigmas = 0.0;
  bool significant = false;
};

struct CalibrationComparison {
  std::vector<ParameterChange> parameters;  ///< of the joints, the most significant first
  double tool_rms = 0.0, tool_worst = 0.0;  ///< [m] tool displacement over the joint ranges, both chains with the base
                                            ///< and tool of the earlier one
  bool changed = false;
};

}  // namespace kinfer
