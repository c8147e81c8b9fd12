// SPDX-License-Identifier: Apache-2.0
// The nominal model that a calibration starts from: of the data sheet, of an earlier calibration, or of joint types
// alone.
#pragma once

#include <optional>

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/calibrate/problem/options.hpp"
#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/evidence/calibration/unknown_robot.hpp"

namespace kinfer::calibrate {

struct StartingModel {
  CalibrationTask task;  ///< with its nominal chain and tolerances
  std::optional<UnknownRobotEvidence> unknown_robot{};
};

/// With joint types alone, the nominal model is estimated from the rows that will be fitted; with
/// JointOffsetParameters, an earlier calibration takes the place of the nominal model. An error where an earlier
/// calibration has other joints.
Result<StartingModel> make_starting_model(const CalibrationTask& given, const CalibrationOptions& options, Rng rng);

/// An error unless an earlier calibration is of the same kind of robot as the nominal one.
Result<void> check_same_joints(const Chain& earlier, const Chain& nominal);

}  // namespace kinfer::calibrate
