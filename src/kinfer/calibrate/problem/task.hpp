// SPDX-License-Identifier: Apache-2.0
// What a calibration starts from: the prior knowledge of the robot and the measurements.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/evidence/fleet/population.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

struct CalibrationTask {
  Chain nominal;
  Tolerances tolerances{};
  std::optional<Instrument> instrument{};  ///< absent: the noise is estimated from the residuals
  PoseSet data{};
  std::optional<Chain> earlier{};         ///< an earlier calibration of this robot: searches start there
  std::vector<Chain> robot_population{};  ///< earlier calibrations of robots of this type: mean and covariance of the
                                          ///< prior
  std::optional<PopulationPrior> population{};  ///< of a merged fleet, in place of `robot_population`
  std::vector<JointType> joint_types{};  ///< of a robot without a data sheet: `nominal` and `tolerances` are then
                                         ///< estimated from the data

  bool has_population() const { return population.has_value() || !robot_population.empty(); }
};

}  // namespace kinfer::calibrate
