// SPDX-License-Identifier: Apache-2.0
// Joint positions and tool points out of robot logs: sensor_msgs/JointState, geometry_msgs/PoseStamped, PointStamped
// and TransformStamped.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// A pose set with what is odd but usable about it, one sentence each.
struct PoseTopic {
  PoseSet set{};
  std::string topic{};  ///< "/joint_states (sensor_msgs/JointState)"
  std::vector<std::string> remarks{};
};

/// Joint positions by the names of the robot's joints; in the order of the message where none of its names is one of
/// the robot's and the counts agree. Messages without all joints (a gripper's) are skipped. `topics`: only one of these
/// is read; empty: the only topic of its type. Time is header.stamp [s since 1970], the log's where it is 0.
Result<PoseTopic> read_joint_topic(const std::filesystem::path& path, const Chain& chain,
                                   std::span<const std::string> topics);

/// Tool points [m], with orientations where the message has them.
Result<PoseTopic> read_point_topic(const std::filesystem::path& path, const Chain& chain,
                                   std::span<const std::string> topics);

/// What kinfer reads of a message type, for the user; empty: nothing.
std::string_view use_of_message_type(std::string_view type);

}  // namespace kinfer
