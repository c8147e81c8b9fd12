// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/motion/trajectory_mcap.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/io/robot/urdf/urdf.hpp"
#include "kinfer/io/robot_log/mcap_writer.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

/// [rad/s] or [m/s] central difference at a row.
VectorXd velocity_at(const PoseSet& set, Eigen::Index row) {
  const Eigen::Index before = std::max<Eigen::Index>(row - 1, 0), after = std::min(row + 1, set.rows() - 1);
  const double span = set.time[static_cast<std::size_t>(after)] - set.time[static_cast<std::size_t>(before)];
  if (!(span > 0.0)) return VectorXd::Zero(set.joints.rows());
  return (set.joints.col(after) - set.joints.col(before)) / span;
}

CdrMessage joint_state(const PoseSet& set, Eigen::Index row, std::int64_t time) {
  CdrMessage message;
  message.time(time).text("");
  message.count(static_cast<std::uint32_t>(set.joint_names.size()));
  for (const std::string& name : set.joint_names) message.text(name);
  for (const VectorXd& values : {VectorXd(set.joints.col(row)), velocity_at(set, row)}) {
    message.count(static_cast<std::uint32_t>(values.size()));
    for (const double value : values) message.number(value);
  }
  message.count(0);  // no efforts
  return message;
}

CdrMessage tool_pose(const Pose& world_T_tool, std::int64_t time) {
  CdrMessage message;
  message.time(time).text("world");
  for (const double value : world_T_tool.position) message.number(value);
  const Quat q(world_T_tool.rotation);
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) message.number(value);
  return message;
}

Result<void> expect_rising_times(const PoseSet& set) {
  if (set.time.empty()) return error("a trajectory needs a column t");
  for (std::size_t row = 1; row < set.time.size(); ++row)
    if (!(set.time[row] > set.time[row - 1]))
      return error("line {}: the time does not rise, {} s after {} s", set.line[row], set.time[row], set.time[row - 1]);
  return {};
}

}  // namespace

Result<void> write_trajectory_mcap(const std::filesystem::path& path, const Chain& chain, const PoseSet& joints) {
  if (auto rising = expect_rising_times(joints); !rising) return rising;
  KINFER_TRY(writer, McapWriter::create(path));
  const std::uint16_t states = writer.add_channel("/joint_states", "sensor_msgs/JointState");
  const std::uint16_t tool = writer.add_channel("/tool", "geometry_msgs/PoseStamped");
  const std::uint16_t description = writer.add_channel("/robot_description", "std_msgs/String");
  for (Eigen::Index row = 0; row < joints.rows(); ++row) {
    const auto time = static_cast<std::int64_t>(std::llround(1e9 * joints.time[static_cast<std::size_t>(row)]));
    if (row == 0) {
      CdrMessage text;
      writer.write(description, time, text.text(format_urdf(chain)));
    }
    writer.write(states, time, joint_state(joints, row, time));
    writer.write(tool, time, tool_pose(forward(chain, joints.joints.col(row)), time));
  }
  return writer.finish();
}

}  // namespace kinfer
