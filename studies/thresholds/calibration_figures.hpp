// SPDX-License-Identifier: Apache-2.0
// How well a fixed set of simulated and, where KINFER_DATA is set, real robots is calibrated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"
#include "studies/thresholds/figures.hpp"

namespace kinfer::study::thresholds_study {

struct MeasuredRobot {
  Chain nominal;
  std::optional<Instrument> instrument;
  PoseSet data;
  std::optional<Chain> truth{};  ///< of a simulated robot
  PoseSet unseen{};              ///< poses without noise that no fit sees, of a simulated robot
};

/// Rigid robots, one with gear errors, one with compliant joints under a payload, one with gross errors, one far from
/// its nominal model, and two series of a real UR10.
std::vector<MeasuredRobot> measured_robots();

Figures calibration_figures(const std::vector<MeasuredRobot>& robots);

}  // namespace kinfer::study::thresholds_study
