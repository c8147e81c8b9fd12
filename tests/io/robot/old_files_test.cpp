// SPDX-License-Identifier: Apache-2.0
// chain.toml as earlier versions wrote them (tests/io/robot/old_files, VERSION_DATE_NAME.toml) are still read.
#include <gmock/gmock.h>

#include <filesystem>
#include <map>

#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/kinematics/poses/tool_poses.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> old_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(KINFER_SOURCE_DIR "/tests/io/robot/old_files"))
    files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

Vec3 tool_position(const Chain& chain) {
  MatrixXd q(dof(chain), 1);
  for (Eigen::Index i = 0; i < q.rows(); ++i) q(i, 0) = 0.1 * static_cast<double>(i + 1);
  std::vector<double> pose(16);
  tool_poses(chain, q, pose, 1);
  return {pose[3], pose[7], pose[11]};
}

TEST(OldFiles, AreReadAndWrittenBackAsTheSameRobot) {
  const auto files = old_files();
  ASSERT_GE(files.size(), 5U);
  for (const fs::path& file : files) {
    const auto robot = read_robot_toml(file);
    ASSERT_TRUE(robot) << robot.error().what;
    const auto again = parse_robot_toml(format_robot_toml(*robot), "again.toml");
    ASSERT_TRUE(again) << again.error().what;
    EXPECT_EQ(active_joint_names(again->chain), active_joint_names(robot->chain)) << file;
    EXPECT_LT((tool_position(again->chain) - tool_position(robot->chain)).norm(), 1e-12) << file;
  }
}

/// Numbers of the files as they were meant: lengths in mm, angles in deg.
TEST(OldFiles, AreReadAsTheyWereMeant) {
  const auto calibrated = read_robot_toml(KINFER_SOURCE_DIR "/tests/io/robot/old_files/0.1_2026-11-22_cal1.toml");
  ASSERT_TRUE(calibrated) << calibrated.error().what;
  const Chain& chain = calibrated->chain;
  ASSERT_EQ(chain.joints.size(), 6U);
  EXPECT_NEAR(chain.base.xyz.x(), 1.1999392505601047, 1e-15);
  const auto* row = std::get_if<MdhLink>(&chain.joints[1].link);
  ASSERT_NE(row, nullptr);
  EXPECT_NEAR(row->a, 0.1666487990097332, 1e-15);
  EXPECT_NEAR(row->alpha, -89.99465043079725 * std::numbers::pi / 180.0, 1e-14);
  EXPECT_NEAR(chain.joints[0].upper, 170.0 * std::numbers::pi / 180.0, 1e-14);
}

}  // namespace
}  // namespace kinfer
