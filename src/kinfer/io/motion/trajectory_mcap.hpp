// SPDX-License-Identifier: Apache-2.0
// Joint trajectories as MCAP, as viewers of robots open them.
#pragma once

#include <filesystem>

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// /joint_states (sensor_msgs/JointState: names, positions, and velocities by differences), /tool
/// (geometry_msgs/PoseStamped in the world) and /robot_description (std_msgs/String, URDF, once). `joints`: rows with
/// times [s], which are written from 1970 on, to the nanosecond. An error where rows have no time or it does not rise.
Result<void> write_trajectory_mcap(const std::filesystem::path& path, const Chain& chain, const PoseSet& joints);

}  // namespace kinfer
