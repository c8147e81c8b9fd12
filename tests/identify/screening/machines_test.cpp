// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/machines.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "identify/hand_made_tree.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Sensors = std::vector<std::size_t>;
using test::Edges;
using test::ordered_by;
using test::revolute_pair;
using test::unrelated_pair;

/// A chain of segments with one link of another kind.
OrderedMotion chain_with(std::size_t segments, const PairFit& link) {
  SegmentTree tree = test::hand_made_tree(segments, test::serial_edges(segments));
  test::replace_pair(tree, link);
  return ordered_by(std::move(tree));
}

TEST(SelectMachine, TakesAllSensorsOfOneMachine) {
  const OrderedMotion ordered = ordered_by(test::hand_made_tree(6, test::serial_edges(6)));
  const RecordingSelection chosen = select_machine(ordered, {});
  EXPECT_EQ(chosen.sensors, (Sensors{0, 1, 2, 3, 4, 5}));
  EXPECT_TRUE(chosen.findings.empty());
}

TEST(SelectMachine, SensorsThatShareSegmentsDoNotMakeTheJointsBetweenLookBad) {
  SegmentTree tree = test::hand_made_tree(12, test::serial_edges(12));
  for (std::size_t i = 0; i + 1 < 12; ++i) {
    PairFit pair = revolute_pair(i, i + 1, i % 3 == 2 ? 0.054 : 0.008);
    if (i % 3 != 2) pair.angular_velocity = 1e-6 * Mat3::Identity();
    test::replace_pair(tree, pair);
  }
  EXPECT_EQ(select_machine(ordered_by(std::move(tree)), {}).sensors.size(), 12u);
}

TEST(SelectMachine, TwoMachinesAreSeparatedAndTheRootSaysWhichOneIsWanted) {
  const OrderedMotion ordered = chain_with(7, unrelated_pair(3, 4, 1.0));
  const RecordingSelection larger = select_machine(ordered, {}), other = select_machine(ordered, "s5");
  EXPECT_EQ(larger.sensors, (Sensors{0, 1, 2, 3}));
  EXPECT_EQ(other.sensors, (Sensors{4, 5, 6}));
  ASSERT_EQ(larger.findings.size(), 1U);
  const Finding& finding = larger.findings[0];
  EXPECT_EQ(finding.kind, FindingKind::several_machines);
  EXPECT_TRUE(finding.applied);
  EXPECT_EQ(finding.values.texts("sensors"), (std::vector<std::string>{"s4", "s5", "s6"}));
  EXPECT_EQ(finding.values.text("link"), "s3-s4");
  EXPECT_NEAR(finding.values.number("residual"), 1.0, 1e-9);
  EXPECT_NE(words::sentence(finding).find("s4, s5, s6"), std::string::npos);
}

TEST(SelectMachine, APartThatMovesWithTheOthersIsNotSurelyAnotherMachine) {
  const OrderedMotion ordered = chain_with(7, unrelated_pair(3, 4, 1.0));
  const auto finding_with = [&](double gain) {
    const PairConnection link{
        .parent = 3,
        .child = 4,
        .whole = {.force_gain = gain, .residual = 1.0, .shifted_residual = 2.0, .shifted_rate = 1.0}};
    return select_machine(ordered, {}, std::span(&link, 1)).findings.at(0);
  };
  EXPECT_FALSE(questions_result(finding_with(0.5)));
  for (const double gain : {2.0, 8.0}) {
    const Finding finding = finding_with(gain);
    EXPECT_TRUE(questions_result(finding));
    EXPECT_NEAR(finding.values.number("connection_gain"), gain, 1e-9);
    EXPECT_NE(words::sentence(finding).find("though they move with them"), std::string::npos);
  }
}

TEST(SelectMachine, ASensorThatRotatesAboutOneAxisIsABarOfALinkageAnotherOneSharesNoJoint) {
  const RecordingSelection bar = select_machine(chain_with(5, revolute_pair(3, 4, 1.0)), {}),
                           stranger = select_machine(chain_with(5, unrelated_pair(3, 4, 1.0)), {});
  for (const RecordingSelection* part : {&bar, &stranger}) {
    EXPECT_EQ(part->sensors, (Sensors{0, 1, 2, 3}));
    ASSERT_EQ(part->findings.size(), 1U);
    EXPECT_EQ(part->findings[0].values.text("sensor"), "s4");
    EXPECT_NE(words::sentence(part->findings[0]).find("s4"), std::string::npos);
  }
  EXPECT_EQ(bar.findings[0].kind, FindingKind::linkage);
  EXPECT_EQ(stranger.findings[0].kind, FindingKind::no_joint);
}

TEST(SelectMachine, ASensorInShortPiecesExplainsAllThatFitsToNoOther) {
  OrderedMotion ordered = chain_with(7, unrelated_pair(3, 4, 1.0));
  ordered.motion.period = 0.01;
  ordered.motion.usable.assign(2600, true);
  ordered.motion.segments[4].restarts = {5.0, 10.0, 15.0, 20.0, 25.0, 30.0};  // seven pieces of 3.7 s
  ordered.motion.segments[1].restarts = std::vector<double>(20, 0.0);         // fits nevertheless
  const RecordingSelection chosen = select_machine(ordered, {});
  EXPECT_EQ(chosen.sensors, (Sensors{0, 1, 2, 3}));
  ASSERT_EQ(chosen.findings.size(), 1U);
  EXPECT_EQ(chosen.findings[0].kind, FindingKind::fragmented_sensor);
  EXPECT_EQ(chosen.findings[0].values.text("sensor"), "s4");
  EXPECT_EQ(chosen.findings[0].values.texts("left_out"), (std::vector<std::string>{"s4", "s5", "s6"}));
  EXPECT_NE(words::sentence(chosen.findings[0]).find("7 pieces of 3.7 s"), std::string::npos);
  ordered.motion.segments[4].restarts.resize(5);  // of 4.3 s
  EXPECT_EQ(select_machine(ordered, {}).findings[0].kind, FindingKind::several_machines);
}

TEST(SelectMachine, ASmallPartMayHaveALargerResidualThanAWholeMachine) {
  EXPECT_EQ(select_machine(chain_with(5, revolute_pair(3, 4, 0.09)), {}).sensors.size(), 5U);
  EXPECT_EQ(select_machine(chain_with(5, revolute_pair(3, 4, 0.11)), {}).sensors.size(), 4U);
  EXPECT_EQ(select_machine(chain_with(6, revolute_pair(2, 3, 0.04)), {}).sensors.size(), 6U);
  EXPECT_EQ(select_machine(chain_with(6, revolute_pair(2, 3, 0.06)), {}).sensors.size(), 3U);
}

TEST(SelectMachine, APrismaticJointIsAJoint) {
  PairFit slide = revolute_pair(3, 4, 0.0);
  slide.angular_velocity.setZero();
  slide.acceleration = Vec3(0.0, 0.0, 4.0).asDiagonal();  // along one direction only
  EXPECT_EQ(select_machine(chain_with(5, slide), {}).sensors.size(), 5U);
  slide.acceleration = Vec3(0.0, 4.0, 4.0).asDiagonal();
  EXPECT_EQ(select_machine(chain_with(5, slide), {}).sensors.size(), 4U);
}

TEST(SelectMachine, WithTwoLinksNoneIsTheUsualOne) {
  EXPECT_EQ(select_machine(chain_with(3, unrelated_pair(1, 2, 5.0)), {}).sensors.size(), 3U);
}

TEST(SelectMachine, SeveralCutsLeaveTheLargestGroup) {
  SegmentTree tree = test::hand_made_tree(8, test::serial_edges(8));
  test::replace_pair(tree, unrelated_pair(0, 1, 2.0));
  test::replace_pair(tree, unrelated_pair(5, 6, 2.0));
  const RecordingSelection chosen = select_machine(ordered_by(std::move(tree)), {});
  EXPECT_EQ(chosen.sensors, (Sensors{1, 2, 3, 4, 5}));
  EXPECT_EQ(chosen.findings.size(), 2U);
}

TEST(GroupsAttachedToWorld, AreTheBranchesOfAStationaryRoot) {
  OrderedMotion ordered = ordered_by(test::hand_made_tree(5, {{0, 1}, {1, 2}, {0, 3}, {3, 4}}));
  EXPECT_TRUE(groups_attached_to_world(ordered).empty()) << "a moving root is a segment like any other";
  ordered.motion.segments[0].still = true;
  const std::vector<Finding> findings = groups_attached_to_world(ordered);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].values.texts("groups"), (std::vector<std::string>{"s1, s2", "s3, s4"}));
  EXPECT_FALSE(findings[0].applied) << "they may be limbs of one machine";
  EXPECT_NE(words::sentence(findings[0]).find("s3, s4"), std::string::npos);
  OrderedMotion serial = ordered_by(test::hand_made_tree(5, test::serial_edges(5)));
  serial.motion.segments[0].still = true;
  EXPECT_TRUE(groups_attached_to_world(serial).empty());
}

enum class Activity { rests, rotates, slides };

/// 20 s at 50 Hz of sensors i0, i1, … with the noise of a cheap INS.
InsRecording recording_of(const std::vector<Activity>& activities) {
  InsRecording recording;
  recording.loggers = {{.name = "log", .time = {}}};
  for (int row = 0; row < 1000; ++row) recording.loggers[0].time.push_back(0.02 * row);
  Rng rng(1);
  for (const Activity activity : activities) {
    InsSensor sensor{.name = "i" + std::to_string(recording.sensors.size()),
                     .acceleration = {},
                     .angular_velocity = {},
                     .field = {},
                     .faults = std::vector<std::uint8_t>(1000, 0)};
    for (const double t : recording.loggers[0].time)
      for (std::size_t k = 0; k < 3; ++k) {
        const double wave = std::sin(2.0 * t), rate = activity == Activity::rotates && k == 2 ? 0.3 * wave : 0.0;
        const double force = (k == 2 ? 9.81 : 0.0) + (activity == Activity::slides && k == 0 ? 0.5 * wave : 0.0);
        sensor.angular_velocity.axis[k].push_back(static_cast<float>(0.004 + rate + 0.005 * rng.normal()));
        sensor.acceleration.axis[k].push_back(static_cast<float>(force + 0.05 * rng.normal()));
      }
    recording.sensors.push_back(std::move(sensor));
  }
  return recording;
}

TEST(IdleSensors, AreLeftOutButForOneThatIsTheRoot) {
  using enum Activity;
  const InsRecording recording = recording_of({rests, rotates, rests, slides, rests});
  const RecordingSelection chosen = exclude_idle_sensors(recording, {}, {});
  EXPECT_EQ(chosen.sensors, (Sensors{0, 1, 3}));
  ASSERT_EQ(chosen.findings.size(), 1U);
  EXPECT_EQ(chosen.findings[0].kind, FindingKind::idle);
  EXPECT_EQ(chosen.findings[0].values.text("kept"), "i0");
  EXPECT_EQ(chosen.findings[0].values.texts("left_out"), (std::vector<std::string>{"i2", "i4"}));
  EXPECT_EQ(exclude_idle_sensors(recording, {}, "i2").sensors, (Sensors{1, 2, 3})) << "the root that the user names";
  EXPECT_EQ(exclude_idle_sensors(recording, {}, "i1").sensors, (Sensors{0, 1, 3}));
}

TEST(IdleSensors, AreNoneIfAtMostOneRestsAndAllIfNothingMoves) {
  using enum Activity;
  for (const auto& activities : {std::vector{rotates, slides}, {rests, rotates}}) {
    const RecordingSelection chosen = exclude_idle_sensors(recording_of(activities), {}, {});
    EXPECT_EQ(chosen.sensors, (Sensors{0, 1}));
    EXPECT_TRUE(chosen.findings.empty());
  }
  EXPECT_TRUE(exclude_idle_sensors(recording_of({rests, rests}), {}, {}).findings.empty())
      << "a later step says that nothing moves";
  EXPECT_TRUE(exclude_idle_sensors({}, {}, {}).sensors.empty());
}

}  // namespace
}  // namespace kinfer
