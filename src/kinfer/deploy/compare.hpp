// SPDX-License-Identifier: Apache-2.0
// Comparison of two calibrations of a robot: which parameters have changed significantly.
//
// Each change is divided by the combined standard deviation of both calibrations. As many parameters are tested at
// once, a change is significant only by Holm's step-down test (1979) with a family-wise error rate of 1 %.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer::deploy {

/// Standard deviation by parameter name, SI.
using DeviationsByName = std::map<std::string, double>;

struct CalibratedRobot {
  Chain chain;
  DeviationsByName sd;
};

struct ParameterChange {
  std::string name;
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
  std::string verdict;  ///< one sentence
};

/// Base and tool belong to a set-up, so only joint parameters are compared. An error where the chains do not have the
/// same joints, or no parameter has a standard deviation in both.
Result<CalibrationComparison> compare_calibrations(const CalibratedRobot& earlier, const CalibratedRobot& later);

}  // namespace kinfer::deploy
