// SPDX-License-Identifier: Apache-2.0
// How the nominal model of a robot without a data sheet was found, and how its axes lie.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinfer {

enum class AxisRelation {
  parallel,      ///< `angle` is the remaining tilt; `distance` of two revolute axes
  at_angle,      ///< one of them is prismatic: only the angle matters
  intersecting,  ///< `distance` is below a millimetre
  skew,
};
std::string_view name(AxisRelation relation);

/// Two neighbouring joint axes of a serial chain.
struct AxisPair {
  std::string first{}, second{};
  AxisRelation relation = AxisRelation::skew;
  double angle = 0.0;                ///< [rad]
  std::optional<double> distance{};  ///< [m] of revolute axes
};

struct AxisGeometry {
  std::vector<AxisPair> pairs{};
  std::vector<std::array<std::string, 3>> wrists{};  ///< three joints whose axes meet in one point
};

struct UnknownRobotEvidence {
  int starts = 0, agreeing = 0;  ///< random starts, and how many of them converged to the chain that was kept
  double median_error = 0.0;     ///< [m] of that chain
  AxisGeometry axes{};
};

}  // namespace kinfer
