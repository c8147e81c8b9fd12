// SPDX-License-Identifier: Apache-2.0
// A calibration written back into the robot file that it was given.
#pragma once

#include <optional>

#include "kinfer/evidence/calibration/model_patch.hpp"
#include "kinfer/io/evidence/files/calibration_files.hpp"

namespace kinfer {

struct PatchedModel {
  ModelPatch patch;
  std::vector<OutputFile> files;  ///< the robot file under the name NAME_calibrated.urdf, model_changes.csv,
                                  ///< placement.toml; of a URDF joint_origins.yaml and kinematics.yaml (UR, Franka),
                                  ///< of an MJCF with separate offsets joint_offsets.yaml
};

/// `robot`: as read, with its source. An error where the file cannot be changed in place, where the calibrated chain is
/// another machine, or where the written file does not have the tool poses of the calibrated chain to 1e-9 m.
Result<PatchedModel> patch_model(const RobotModel& robot, const Calibration& calibration,
                                 EncoderOffsets offsets = EncoderOffsets::folded);

/// joint, line, changes [mm, deg], offset: one row per joint of the patched file that changed.
std::string format_model_changes_csv(const ModelPatch& patch);

}  // namespace kinfer
