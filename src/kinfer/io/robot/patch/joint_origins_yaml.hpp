// SPDX-License-Identifier: Apache-2.0
// Joint origins as YAML, for robot descriptions that are generated from numbers (xacro).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/evidence/calibration/model_patch.hpp"
#include "kinfer/io/robot/patch/urdf_joints.hpp"

namespace kinfer {

/// joint_origins: joint: {x y z [m], roll pitch yaw [rad]} of every joint that moves; joint_offsets [rad] or [m] where
/// they are separate.
std::string format_joint_origins_yaml(const UrdfJointPositions& joints, const ModelPatch& patch);

/// joint_offsets alone [rad] or [m], for files whose origins are elsewhere.
std::string format_joint_offsets_yaml(const ModelPatch& patch);

/// The form that ur_description loads (kinematics: shoulder, upper_arm, forearm, wrist_1 to 3) or franka_description
/// (joint1: kinematic: …), chosen by the names of links and joints. None for other robots.
std::optional<std::string> format_kinematics_yaml(const UrdfJointPositions& joints);

}  // namespace kinfer
