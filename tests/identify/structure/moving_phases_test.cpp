// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/moving_phases.hpp"

#include <gtest/gtest.h>

#include "identify/hand_made_tree.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Spans = std::vector<std::pair<double, double>>;  // [s] in which a segment moves

/// 20 s at 100 Hz; every segment rotates at 0.3 rad/s in its spans and rests otherwise.
RecordedMotion motion_with(const std::vector<Spans>& segments, double start = 0.0) {
  RecordedMotion motion;
  motion.period = 0.01;
  for (int row = 0; row < 2000; ++row) motion.time.push_back(start + 0.01 * row);
  motion.usable.assign(2000, true);
  motion.first_motion_row = 100;
  for (const Spans& spans : segments) {
    SegmentMotion segment{.name = "s" + std::to_string(motion.segments.size()),
                          .rotation = std::vector<Mat3>(2000, Mat3::Identity()),
                          .gyro = std::vector<Vec3>(2000, Vec3::Zero()),
                          .angular_velocity = std::vector<Vec3>(2000, Vec3::Zero()),
                          .angular_acceleration = std::vector<Vec3>(2000, Vec3::Zero()),
                          .acceleration = std::vector<Vec3>(2000, Vec3::Zero())};
    for (std::size_t row = 0; row < 2000; ++row)
      for (const auto& [begin, end] : spans)
        if (motion.time[row] - start >= begin && motion.time[row] - start < end)
          segment.angular_velocity[row] = 0.3 * Vec3::UnitZ();
    motion.segments.push_back(std::move(segment));
  }
  return motion;
}

using Parents = std::vector<std::optional<std::size_t>>;

TEST(MovingPhases, OfASerialMachineRankItsSegments) {
  const MovingPhases table = moving_phases(motion_with({{}, {{2, 5}}, {{2, 5}, {6, 9}}, {{2, 5}, {6, 9}, {10, 13}}}));
  EXPECT_EQ(table.phases.size(), 3U);
  EXPECT_EQ(table.rank, (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(table.parent, (Parents{std::nullopt, 0, 1, 2}));
  EXPECT_TRUE(table.is_unambiguous);
  EXPECT_TRUE(has_same_parents(table, test::hand_made_tree(4, test::serial_edges(4))));
  EXPECT_FALSE(has_same_parents(table, test::hand_made_tree(4, {{0, 1}, {0, 2}, {2, 3}})));
}

TEST(MovingPhases, DoNotDependOnTheOrderOfTheSensors) {
  const MovingPhases table = moving_phases(motion_with({{{2, 5}, {6, 9}}, {{2, 5}, {6, 9}, {10, 13}}, {}, {{2, 5}}}));
  EXPECT_EQ(table.rank, (std::vector{2, 3, 0, 1}));
  EXPECT_EQ(table.parent, (Parents{3, 0, std::nullopt, 2}));
}

TEST(MovingPhases, FindTwoLimbsOfOneSegment) {
  const MovingPhases table = moving_phases(motion_with({{}, {{2, 5}}, {{2, 5}, {6, 9}}, {{2, 5}, {10, 13}}}));
  EXPECT_EQ(table.parent, (Parents{std::nullopt, 0, 1, 1}));
  EXPECT_TRUE(table.is_unambiguous);
}

TEST(MovingPhases, ARepeatedPhaseCountsOnceAndBeginsWhereItAppearsFirst) {
  const MovingPhases table = moving_phases(motion_with({{}, {{2, 5}, {9, 12}}}, 100.0));
  ASSERT_EQ(table.phases.size(), 1U);
  EXPECT_NEAR(table.phases[0].begin, 102.0, 0.26);
  EXPECT_NEAR(table.phases[0].end, 105.0, 0.26);
  EXPECT_EQ(table.rank, (std::vector{0, 1}));
}

TEST(MovingPhases, ATransitionOfHalfASecondIsNoPhase) {
  EXPECT_TRUE(moving_phases(motion_with({{}, {{2, 2.5}}})).phases.empty());
  EXPECT_EQ(moving_phases(motion_with({{}, {{2, 4}}, {{2, 4.5}}})).phases.size(), 1U)
      << "the half second in which the last segment still moves";
}

TEST(MovingPhases, ASegmentOnAPrismaticJointMovesWithoutRotation) {
  RecordedMotion motion = motion_with({{}, {{2, 5}}, {{2, 5}}});
  for (std::size_t row = 700; row < 900; ++row)
    motion.segments[2].acceleration[row] = (row % 2 == 0 ? 0.5 : -0.5) * Vec3::UnitX();
  const MovingPhases table = moving_phases(motion);
  EXPECT_EQ(table.rank, (std::vector{0, 1, 2}));
  EXPECT_EQ(table.parent, (Parents{std::nullopt, 0, 1}));
}

TEST(MovingPhases, AnAccelerometerBiasIsNoMotion) {
  RecordedMotion motion = motion_with({{}, {{2, 5}}});
  for (Vec3& a : motion.segments[0].acceleration) a = Vec3(0.0, 0.0, 0.5);
  EXPECT_EQ(moving_phases(motion).rank, (std::vector{0, 1}));
}

TEST(MovingPhases, SensorsThatAlwaysMoveTogetherAreAmbiguous) {
  const MovingPhases table = moving_phases(motion_with({{}, {{2, 5}}, {{2, 5}}}));
  EXPECT_FALSE(table.is_unambiguous);
  EXPECT_FALSE(has_same_parents(table, test::hand_made_tree(3, test::serial_edges(3))));
  EXPECT_FALSE(moving_phases(motion_with({{}, {}})).is_unambiguous) << "nothing moves";
  EXPECT_TRUE(moving_phases(motion_with({{{2, 5}}})).is_unambiguous) << "one segment";
}

}  // namespace
}  // namespace kinfer
