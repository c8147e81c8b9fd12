// SPDX-License-Identifier: Apache-2.0
// Comparison of two calibrations of a robot: which parameters have changed significantly.
//
// Each change is divided by the combined standard deviation of both calibrations. As many parameters are tested at
// once, a change is significant only by Holm's step-down test (1979) with a family-wise error rate of 1 %.
#pragma once

#include <map>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/deployment/calibration_comparison.hpp"

namespace kinfer::deploy {

/// Standard deviation by parameter name, SI.
using DeviationsByName = std::map<std::string, double>;

struct CalibratedRobot {
  Chain chain;
  DeviationsByName sd;
};

/// Base and tool belong to a set-up, so only joint parameters are compared. An error where the chains do not have the
/// same joints, or no parameter has a standard deviation in both.
Result<CalibrationComparison> compare_calibrations(const CalibratedRobot& earlier, const CalibratedRobot& later);

}  // namespace kinfer::deploy
