// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/pose_topics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "kinfer/io/motion/trajectory_mcap.hpp"
#include "kinfer/io/pose_set/paired_files.hpp"
#include "kinfer/io/robot_log/mcap_writer.hpp"
#include "kinfer/io/robot_log/message_log_formats.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Three hinges that are not parallel, 0.5 m apart.
Chain three_hinges() {
  Chain chain;
  for (int j = 0; j < 3; ++j) {
    MdhLink link;
    link.a = j == 0 ? 0.0 : 0.5;
    link.alpha = j == 1 ? 1.57 : 0.0;
    link.d = 0.1;
    chain.joints.push_back(Joint{.name = "j" + std::to_string(j + 1), .parent = j - 1, .link = link});
  }
  chain.tool.xyz = {0.3, 0.0, 0.1};
  return chain;
}

/// Moves and rests of about a second each.
PoseSet motion_of(const Chain& chain) {
  PoseSet set;
  set.joint_names = active_joint_names(chain);
  constexpr int stops = 8, rows_a_stop = 200;
  set.joints.resize(3, stops * rows_a_stop);
  for (int row = 0; row < stops * rows_a_stop; ++row) {
    const double stop = row / rows_a_stop, part = row % rows_a_stop;
    const double moved = stop + std::clamp((part - 100.0 - 8.0 * stop) / 60.0, 0.0, 1.0);
    set.joints.col(row) = Vec3(0.3 * std::sin(1.7 * moved), 0.5 * std::cos(moved), 0.4 * std::sin(0.9 * moved + 1.0));
    set.time.push_back(1.7e9 + 0.01 * row);
    set.line.push_back(row + 2);
  }
  return set;
}

class PoseTopics : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  const Chain chain = three_hinges();
  const fs::path folder = fs::path(::testing::TempDir()) / ("kinfer_pose_topics_" + std::to_string(getpid()));
};

TEST_F(PoseTopics, ATrajectoryAndItsToolComeBackFromMcap) {
  const PoseSet motion = motion_of(chain);
  ASSERT_TRUE(write_trajectory_mcap(folder / "drive.mcap", chain, motion));
  const auto joints = read_joint_topic(folder / "drive.mcap", chain, {});
  ASSERT_TRUE(joints) << joints.error().what;
  EXPECT_EQ(joints->topic, "/joint_states (sensor_msgs/JointState)");
  ASSERT_EQ(joints->set.rows(), motion.rows());
  EXPECT_LT((joints->set.joints - motion.joints).cwiseAbs().maxCoeff(), 1e-12);
  const auto points = read_point_topic(folder / "drive.mcap", chain, {});
  ASSERT_TRUE(points) << points.error().what;
  ASSERT_EQ(points->set.points.size(), static_cast<std::size_t>(motion.rows()));
  EXPECT_LT((points->set.points[777].position - forward(chain, motion.joints.col(777)).position).norm(), 1e-9);
  EXPECT_EQ(points->set.orientations.size(), points->set.points.size());
}

TEST_F(PoseTopics, JointsAndTrackerInOneLogArePairedByTime) {
  ASSERT_TRUE(write_trajectory_mcap(folder / "drive.mcap", chain, motion_of(chain)));
  const auto paired =
      read_paired_files({.joints = folder / "drive.mcap", .measured = folder / "drive.mcap"}, chain, {});
  ASSERT_TRUE(paired) << paired.error().what;
  EXPECT_EQ(paired->pairing.method, PairingMethod::time);
  EXPECT_GE(paired->pairing.pairs.size(), 7U);
  EXPECT_NEAR(paired->pairing.offset, 0.0, 0.02);
  EXPECT_LT(paired->pairing.distance_error, 1e-6);
}

TEST_F(PoseTopics, AFolderOfPartsIsOneLog) {
  const PoseSet motion = motion_of(chain);
  fs::create_directories(folder / "bag");
  std::ofstream(folder / "bag/metadata.yaml") << "rosbag2_bagfile_information:\n  version: 5\n";
  std::vector<int> rows(static_cast<std::size_t>(motion.rows()));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
  const auto half = static_cast<std::ptrdiff_t>(rows.size() / 2);
  // Numbers order the parts: 2 before 10.
  ASSERT_TRUE(
      write_trajectory_mcap(folder / "bag/drive_2.mcap", chain, select(motion, {rows.begin(), rows.begin() + half})));
  ASSERT_TRUE(
      write_trajectory_mcap(folder / "bag/drive_10.mcap", chain, select(motion, {rows.begin() + half, rows.end()})));
  EXPECT_TRUE(is_message_log_file(folder / "bag"));
  const auto joints = read_joint_topic(folder / "bag", chain, {});
  ASSERT_TRUE(joints) << joints.error().what;
  ASSERT_EQ(joints->set.rows(), motion.rows());
  EXPECT_LT((joints->set.joints - motion.joints).cwiseAbs().maxCoeff(), 1e-12);
  fs::create_directories(folder / "empty");
  EXPECT_FALSE(is_message_log_file(folder / "empty"));
}

/// Two topics of joint states: one names the joints in another order and a gripper, one has other names.
void write_two_arms(const fs::path& file) {
  auto writer = McapWriter::create(file);
  ASSERT_TRUE(writer);
  const auto arm = writer->add_channel("/arm/joint_states", "sensor_msgs/JointState");
  const auto other = writer->add_channel("/other/joint_states", "sensor_msgs/JointState");
  const auto transforms = writer->add_channel("/tracker", "geometry_msgs/TransformStamped");
  for (int row = 0; row < 5; ++row) {
    const std::int64_t time = 1'000'000 * (row + 1);
    CdrMessage state;
    state.time(time).text("").count(4);
    for (const char* name : {"gripper", "j3", "j1", "j2"}) state.text(name);
    state.count(4);
    for (const double q : {9.0, 3.0, 1.0, 2.0}) state.number(q + 0.1 * row);
    state.count(0), state.count(0);
    writer->write(arm, time, state);
    CdrMessage foreign;
    foreign.time(time).text("").count(3);
    for (const char* name : {"a", "b", "c"}) foreign.text(name);
    foreign.count(3);
    for (const double q : {1.0, 2.0, 3.0}) foreign.number(q);
    foreign.count(0), foreign.count(0);
    writer->write(other, time, foreign);
    CdrMessage transform;
    transform.time(0).text("world").text("tool");
    for (const double v : {0.1, 0.2, 0.3, 0.0, 0.0, 0.0, 1.0}) transform.number(v);
    writer->write(transforms, time, transform);
  }
  ASSERT_TRUE(writer->finish());
}

TEST_F(PoseTopics, TopicsAreChosenByNameAndJointsByTheirNames) {
  write_two_arms(folder / "arms.mcap");
  EXPECT_THAT(read_joint_topic(folder / "arms.mcap", chain, {}).error().what,
              HasSubstr("2 topics could be used (/arm/joint_states, /other/joint_states); --topic says which"));
  const std::vector<std::string> arm{"/arm/joint_states"}, other{"/other/joint_states"};
  const auto joints = read_joint_topic(folder / "arms.mcap", chain, arm);
  ASSERT_TRUE(joints) << joints.error().what;
  EXPECT_LT((joints->set.joints.col(1) - Vec3(1.1, 2.1, 3.1)).norm(), 1e-12);
  const auto by_order = read_joint_topic(folder / "arms.mcap", chain, other);
  ASSERT_TRUE(by_order) << by_order.error().what;
  EXPECT_THAT(by_order->remarks.at(0), HasSubstr("a, b, c are taken as j1, j2, j3"));
  const auto points = read_point_topic(folder / "arms.mcap", chain, {});
  ASSERT_TRUE(points) << points.error().what;
  EXPECT_LT((points->set.points[0].position - Vec3(0.1, 0.2, 0.3)).norm(), 1e-12);
  EXPECT_NEAR(points->set.time[4] - points->set.time[0], 0.004, 1e-6) << "without a stamp the time of the log counts";
  EXPECT_THAT(read_point_topic(folder / "arms.mcap", chain, arm).error().what,
              HasSubstr("no topic of those that --topic names of geometry_msgs/PoseStamped"));
}

}  // namespace
}  // namespace kinfer
