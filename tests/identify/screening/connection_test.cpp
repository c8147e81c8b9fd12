// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/connection.hpp"

#include <gtest/gtest.h>

#include "identify/measured_segments.hpp"
#include "kinfer/identify/screening/unconnected.hpp"

namespace kinfer {
using namespace identify;
namespace {

/// A segment that is carried along and rotates about three axes.
std::vector<FrameState> long_motion(double phase, double pace) {
  const std::vector<JointSignal> signals{test::wave(0.7, 0.6 * pace, phase), test::wave(0.5, 0.8 * pace, 1.0 + phase),
                                         test::wave(0.6, 0.45 * pace, phase)};
  const std::vector<DhLeaf> leaves{{.alpha = 1.3, .a = 0.4, .theta_signal = 0},
                                   {.d = 0.3, .alpha = -1.2, .theta_signal = 1},
                                   {.a = 0.2, .theta_signal = 2}};
  return propagate(std::vector<FrameState>(signals[0].angle.size()), leaves, signals);
}

RecordedMotion chain_of_three() {
  return test::serial_machine(long_motion(0.0, 1.0), 3, test::general_hinge());
}

/// The third segment has nothing to do with the first two.
RecordedMotion with_stranger() {
  RecordedMotion motion = chain_of_three();
  motion.segments[2] = test::measured_segment("c", long_motion(2.0, 1.37));
  return motion;
}

TEST(Connection, OfTwoSegmentsWithAJointIsStrong) {
  const PairConnection pair = pair_connection(chain_of_three(), 0, 1);
  EXPECT_GT(pair.whole.gain(), 10.0);
  EXPECT_EQ(strength_of(pair.whole), ConnectionStrength::strong);
  EXPECT_FALSE(only_connected_part(pair));
  EXPECT_FALSE(has_changed(pair));
}

TEST(Connection, OfSegmentsThatMoveByThemselvesIsNone) {
  const PairConnection pair = pair_connection(with_stranger(), 0, 2);
  EXPECT_LT(std::abs(pair.whole.gain()), 1.5);
  EXPECT_EQ(strength_of(pair.whole), ConnectionStrength::none);
}

TEST(Connection, IsNeitherForNorAgainstWhereNothingMoves) {
  EXPECT_EQ(strength_of({.shifted_residual = 0.01, .shifted_rate = 0.001}), ConnectionStrength::unexcited);
  EXPECT_EQ(strength_of({.shifted_residual = 1.0, .shifted_rate = 0.001}), ConnectionStrength::none);
  EXPECT_EQ(strength_of({.force_gain = 3.0, .residual = 1.0, .shifted_residual = 3.0}), ConnectionStrength::weak);
  EXPECT_EQ(strength_of({.force_gain = 3.0, .residual = 0.03, .shifted_residual = 0.1}), ConnectionStrength::strong)
      << "it explains all that there is";
}

TEST(Connection, BesideASegmentAtRestIsThatOfAFixedPoint) {
  RecordedMotion motion = test::serial_machine(test::at_rest(), 2, test::general_hinge());
  EXPECT_EQ(strength_of(pair_connection(motion, 0, 1).whole), ConnectionStrength::strong);
  motion.segments[1] = test::measured_segment("b", test::freely_moving());
  motion.segments[0] = test::measured_segment("a", test::at_rest());
  for (Vec3& acceleration : motion.segments[1].acceleration)  // no point of it is at rest
    acceleration += Vec3(std::sin(acceleration.x() * 7.0), std::cos(acceleration.y() * 5.0), 0.5);
  EXPECT_NE(strength_of(pair_connection(motion, 0, 1).whole), ConnectionStrength::strong);
}

TEST(Connection, BesideASegmentAtRestIsAlsoThatOfASlideAlongOneLine) {
  RecordedMotion motion = test::serial_machine(test::at_rest(), 2, test::general_hinge());
  motion.segments[0] = test::measured_segment("a", test::at_rest());
  motion.segments[1] = test::measured_segment("b", test::at_rest());
  const auto slide = [&](const Vec3& direction, const Vec3& other) {
    for (std::size_t i = 0; i < motion.rows(); ++i) {
      const double at = 0.05 * static_cast<double>(i);
      motion.segments[1].acceleration[i] = 0.3 * (std::sin(at) * direction + std::cos(1.3 * at) * other);
    }
    return strength_of(pair_connection(motion, 0, 1).whole);
  };
  EXPECT_EQ(slide(Vec3(0.6, 0.0, 0.8), Vec3::Zero()), ConnectionStrength::strong);
  EXPECT_EQ(slide(Vec3(0.6, 0.0, 0.8), Vec3(0.0, 0.9, 0.5)), ConnectionStrength::none) << "in a plane";
}

TEST(Connection, InOneHalfAloneIsAMixedRecording) {
  const PartConnection good{0.0, 10.0, {.force_gain = 12.0, .residual = 0.02, .shifted_residual = 2.0}},
      bad{10.0, 20.0, {.force_gain = 0.1, .residual = 1.9, .shifted_residual = 2.0}},
      still{10.0, 20.0, {.force_gain = 0.1, .residual = 0.05, .shifted_residual = 0.06}};
  const auto pair = [](const PartConnection& first, const PartConnection& second) {
    return PairConnection{.parent = 0, .child = 1, .halves = {first, second}};
  };
  EXPECT_EQ(only_connected_part(pair(good, bad))->begin, 0.0);
  EXPECT_EQ(only_connected_part(pair(bad, good))->end, 10.0);
  EXPECT_FALSE(only_connected_part(pair(good, good)));
  EXPECT_FALSE(only_connected_part(pair(good, still))) << "nothing to explain in the second half";
  PairConnection fifths{.parts = {good, good, bad, bad, bad}};
  EXPECT_TRUE(only_connected_part(fifths));
  fifths.parts = {good, bad, bad, bad, bad};
  EXPECT_FALSE(only_connected_part(fifths)) << "one part may be an accident";
}

TEST(Connection, OfHalvesThatExceedTheWholeHasChanged) {
  PairConnection pair{.whole = {.force_gain = 4.0}, .length = -12.0};
  pair.halves = {{0.0, 1.0, {.force_gain = 12.0}, -20.0}, {1.0, 2.0, {.force_gain = 7.0}, -15.0}};
  EXPECT_TRUE(has_changed(pair));
  pair.halves[0].length = -13.0;
  EXPECT_FALSE(has_changed(pair)) << "the joint of the whole leaves no more: only what is shifted differs";
  pair.halves[0].length = -20.0;
  pair.halves[1].connection.force_gain = 5.0;
  EXPECT_FALSE(has_changed(pair));
}

OrderedMotion ordered_for_connection(RecordedMotion motion) {
  const auto tree = segment_tree(motion, "a");
  EXPECT_TRUE(tree) << tree.error().what;
  return {.motion = std::move(motion), .tree = *tree};
}

TEST(ConnectedSegments, OfASoundRecordingAreAll) {
  const OrderedMotion ordered = ordered_for_connection(chain_of_three());
  const auto connections = tree_connections(ordered.motion, ordered.tree, 1);
  EXPECT_FALSE(is_unconnected(connections));
  const RecordingSelection chosen = select_connected(ordered, connections, {}, 1);
  EXPECT_EQ(chosen.sensors.size(), 3U);
  EXPECT_TRUE(chosen.findings.empty());
}

TEST(ConnectedSegments, LeaveAStrangerOutByName) {
  const OrderedMotion ordered = ordered_for_connection(with_stranger());
  const auto connections = tree_connections(ordered.motion, ordered.tree, 1);
  const RecordingSelection chosen = select_connected(ordered, connections, {}, 1);
  EXPECT_EQ(chosen.sensors, (std::vector<std::size_t>{0, 1}));
  ASSERT_EQ(chosen.findings.size(), 1U);
  EXPECT_EQ(chosen.findings[0].kind, FindingKind::not_connected);
  EXPECT_EQ(chosen.findings[0].severity, Severity::warning);
  EXPECT_EQ(chosen.findings[0].values.text("sensor"), "c");
}

TEST(ConnectedSegments, WithoutAnyConnectionThereIsNothingToSeparate) {
  RecordedMotion motion = with_stranger();
  motion.segments[1] = test::measured_segment("b", long_motion(4.0, 0.83));
  const OrderedMotion ordered = ordered_for_connection(std::move(motion));
  const auto connections = tree_connections(ordered.motion, ordered.tree, 2);
  EXPECT_TRUE(is_unconnected(connections));
  EXPECT_EQ(select_connected(ordered, connections, {}, 1).sensors.size(), 3U);
}

TEST(ConnectedSegments, AreThoseOfTheRootIfItHasANeighbour) {
  RecordedMotion motion = with_stranger();
  motion.segments.push_back(motion.segments[2]);
  motion.segments[3].name = "d";
  const OrderedMotion ordered = ordered_for_connection(std::move(motion));
  const auto connections = tree_connections(ordered.motion, ordered.tree, 1);
  EXPECT_EQ(select_connected(ordered, connections, "a", 1).sensors, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(select_connected(ordered, connections, "d", 1).sensors, (std::vector<std::size_t>{2, 3}));
  const auto findings = select_connected(ordered, connections, "a", 1).findings;
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, FindingKind::several_machines);
  EXPECT_EQ(findings[0].values.texts("sensors"), (std::vector<std::string>{"c", "d"}));
}

TEST(ConnectedSegments, OutnumberedByStrangersAreAFault) {
  RecordedMotion motion = with_stranger();
  motion.segments.push_back(test::measured_segment("d", long_motion(4.0, 0.83)));
  motion.segments.push_back(test::measured_segment("e", long_motion(1.0, 0.59)));
  const OrderedMotion ordered = ordered_for_connection(std::move(motion));
  const auto connections = tree_connections(ordered.motion, ordered.tree, 1);
  const RecordingSelection chosen = select_connected(ordered, connections, {}, 1);
  EXPECT_EQ(chosen.sensors, (std::vector<std::size_t>{0, 1}));
  ASSERT_EQ(chosen.findings.size(), 3U);
  for (const Finding& finding : chosen.findings) EXPECT_TRUE(invalidates_result(finding));
}

}  // namespace
}  // namespace kinfer
