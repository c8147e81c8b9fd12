// What changed in a robot between two calibrations, and whether that is more than chance.
//
// Each number's change is counted in sigmas of both calibrations together; as many numbers are looked at, a change
// counts only where Holm's step-down test (1979) refuses chance for the whole family at 1 %.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

/// By parameter name, SI.
using DeviationsByName = std::map<std::string, double>;

struct CalibratedRobot {
  Chain chain;
  DeviationsByName sd;
};

struct ParameterChange {
  std::string name;
  Quantity quantity = Quantity::length;
  double before = 0.0, after = 0.0, change = 0.0;  ///< [m], [rad] …; a URDF frame's turn: 0 and the turn between both
  double sd = 0.0;                                 ///< of the change
  double sigmas = 0.0;
  bool significant = false;
};

struct Changes {
  std::vector<ParameterChange> parameters;  ///< of the joints, the most significant first
  double tool_rms = 0.0, tool_worst = 0.0;  ///< [m] how far the tool moved over the joint ranges, base and tool of the
                                            ///< earlier chain for both
  bool changed = false;
  std::string verdict;  ///< one sentence
};

/// Base and tool belong to a set-up, so only the joints' numbers are compared. An error where the robots are not of one
/// kind, or no number has a standard deviation in both.
Result<Changes> compare_calibrations(const CalibratedRobot& earlier, const CalibratedRobot& later);

}  // namespace kinfer
