// SPDX-License-Identifier: Apache-2.0
// How a robot without a data sheet was found, in words.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/calibration/unknown_robot.hpp"

namespace kinfer::words {

/// "J2 and J3 are parallel (0.002 deg), 612.00 mm apart", "J4, J5 and J6 meet in one point: a wrist", one per relation.
std::vector<std::string> axis_sentences(const AxisGeometry& axes);

/// How it was found, and its axes.
std::vector<std::string> unknown_robot_sentences(const UnknownRobotEvidence& robot);

}  // namespace kinfer::words
