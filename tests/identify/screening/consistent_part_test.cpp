// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "identify/measured_segments.hpp"
#include "kinfer/identify/screening/session.hpp"

namespace kinfer {
using namespace identify;
namespace {

OrderedMotion ordered_motion(RecordedMotion motion, const std::string& root = "a") {
  const auto tree = segment_tree(motion, root);
  EXPECT_TRUE(tree) << tree.error().what;
  return {.motion = std::move(motion), .tree = *tree};
}

RecordedMotion four_in_series(double phase = 0.0) {
  return test::serial_machine(test::freely_moving(phase), 4, test::general_hinge());
}

std::optional<RecordingSelection> consistent_part(
    const OrderedMotion& ordered, MachineSeparation separation = MachineSeparation::of_unconnected_groups,
    int threads = 1) {
  const auto connections = tree_connections(ordered.motion, ordered.tree, threads);
  return select_consistent_part(ordered, connections, {}, separation, threads);
}

TEST(ConsistentPart, OfAFaultlessRecordingIsAllOfIt) {
  EXPECT_FALSE(consistent_part(ordered_motion(four_in_series())));
}

/// Sensor c is rotated in its mount at this row.
OrderedMotion remounted_at(std::size_t row) {
  RecordedMotion motion = four_in_series();
  SegmentMotion& segment = motion.segments[2];
  const Mat3 turn = exp_so3(Vec3(0.3, -0.2, 0.25));
  for (std::size_t i = row; i < motion.rows(); ++i) {
    segment.rotation[i] = segment.rotation[i] * turn;
    segment.gyro[i] = turn.transpose() * segment.gyro[i];
  }
  return ordered_motion(std::move(motion));
}

TEST(ConsistentPart, OfARemountedSensorIsTheMoreInformativeSide) {
  for (const std::size_t row : {200U, 400U}) {
    const auto part = consistent_part(remounted_at(row));
    ASSERT_TRUE(part) << row;
    EXPECT_EQ(part->sensors.size(), 4U) << "the other sensors lose the same time";
    ASSERT_EQ(part->findings.size(), 1U);
    EXPECT_EQ(part->findings[0].kind, FindingKind::remounted);
    EXPECT_EQ(part->findings[0].values.text("sensor"), "c");
    const double time = 0.01 * static_cast<double>(row);
    EXPECT_LE(part->findings[0].values.number("begin"), time);
    EXPECT_GE(part->findings[0].values.number("end"), time);
    EXPECT_EQ(std::isfinite(part->begin), row == 200) << "the longer side is after an early and before a late event";
    EXPECT_EQ(std::isfinite(part->end), row == 400);
  }
}

TEST(ConsistentPart, OfARemountedSensorIsTheSameForAnyNumberOfThreads) {
  const OrderedMotion ordered = remounted_at(250);
  const auto one = consistent_part(ordered);
  ASSERT_TRUE(one);
  for (const int threads : {2, 7}) {
    const auto many = consistent_part(ordered, MachineSeparation::of_unconnected_groups, threads);
    ASSERT_TRUE(many);
    EXPECT_EQ(many->begin, one->begin);
    EXPECT_EQ(many->findings[0].values, one->findings[0].values);
  }
}

TEST(ConsistentPart, OfTwoMachinesIsTheLargerUnlessTheUserKnowsBetter) {
  RecordedMotion motion = four_in_series();
  RecordedMotion other = test::serial_machine(test::freely_moving(1.7), 3, test::general_hinge());
  for (SegmentMotion& segment : other.segments) {
    segment.name = "other_" + segment.name;
    motion.segments.push_back(std::move(segment));
  }
  const OrderedMotion ordered = ordered_motion(std::move(motion));
  const auto part = consistent_part(ordered);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->sensors, (std::vector<std::size_t>{0, 1, 2, 3}));
  ASSERT_EQ(part->findings.size(), 1U);
  EXPECT_EQ(part->findings[0].kind, FindingKind::several_machines);
  EXPECT_FALSE(consistent_part(ordered, MachineSeparation::none)) << "the tree was given";
}

TEST(AlignHeadings, BringsAllSegmentsIntoTheWorldOfTheRoot) {
  RecordedMotion motion = four_in_series();
  const RecordedMotion north = motion;
  const double headings[] = {0.0, 1.1, -2.4, 0.6};
  for (std::size_t s = 0; s < 4; ++s) test::rotate_world(motion.segments[s], headings[s]);
  for (const char* root : {"a", "c"}) {
    OrderedMotion ordered = ordered_motion(motion, root);
    align_headings(ordered.motion, ordered.tree);
    const double of_root = headings[ordered.tree.root];
    for (std::size_t s = 0; s < 4; ++s)
      for (const std::size_t row : {0U, 333U}) {
        const Mat3 expected = rot_z(of_root) * north.segments[s].rotation[row];
        EXPECT_LT((ordered.motion.segments[s].rotation[row] - expected).norm(), 5e-3) << root << s;
        const Vec3 acceleration = rot_z(of_root) * north.segments[s].acceleration[row];
        EXPECT_LT((ordered.motion.segments[s].acceleration[row] - acceleration).norm(),
                  5e-3 * (1.0 + acceleration.norm()));
      }
  }
}

}  // namespace
}  // namespace kinfer
