// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/pipeline.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "identify/driven_machine.hpp"
#include "kinfer/identify/structure/moving_phases.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/words/identification/verdict.hpp"

namespace kinfer {
using namespace identify;
namespace {

namespace fs = std::filesystem;
using test::DrivenMachine;
using test::line_error;

DrivenMachine driven_machine(const std::string& name, const MachineOptions& options, Script script, std::uint64_t seed,
                             const char* grade = "noise") {
  const MujocoWorld world = test::world_of(name, options, seed);
  const MachineMotion motion = world.prescribe(test::drive_of(world.machine(), {.script = script}), 100.0);
  return {simulate_recording(world.machine(), motion, *sensor_grade(grade), {}, Rng(seed)),
          machine_truth(world.machine(), motion)};
}

std::vector<std::string> edges(const SegmentTree& tree, const RecordedMotion& motion) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < tree.parent.size(); ++i)
    if (tree.parent[i]) names.push_back(motion.segments[*tree.parent[i]].name + "-" + motion.segments[i].name);
  return names;
}

std::vector<std::string> edges(const MachineTruth& truth) {
  std::vector<std::string> names;
  for (const JointTruth& joint : truth.joints) names.push_back(joint.parent + "-" + joint.child);
  return names;
}

class EveryMachineAndScript : public testing::TestWithParam<std::tuple<std::string, Script>> {};
INSTANTIATE_TEST_SUITE_P(Order, EveryMachineAndScript,
                         testing::Combine(testing::ValuesIn(machine_names()),
                                          testing::Values(Script::standard, Script::together, Script::gentle)));

TEST_P(EveryMachineAndScript, HasTheRightTree) {
  const auto& [name, script] = GetParam();
  for (const Base base : {Base::still, Base::rocking}) {
    const DrivenMachine drive = driven_machine(name, {.base = base}, script, 3);
    const auto ordered = order_segments(drive.recording, {}, drive.truth.root, 0);
    ASSERT_TRUE(ordered);
    EXPECT_THAT(edges(ordered->tree, ordered->motion), testing::UnorderedElementsAreArray(edges(drive.truth)))
        << "base " << static_cast<int>(base);
  }
}

TEST(MovingPhases, RankTheSegmentsOfARigidMachineOnAStationaryBase) {
  const DrivenMachine drive = driven_machine("excavator", {}, Script::standard, 1);
  const auto motion = segment_motion(drive.recording);
  ASSERT_TRUE(motion);
  const MovingPhases table = moving_phases(*motion);
  EXPECT_THAT(table.rank, testing::ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_TRUE(has_same_parents(table, *segment_tree(*motion)));
}

TEST(MovingPhases, DetectAPrismaticJoint) {
  const DrivenMachine drive = driven_machine("crane", {}, Script::standard, 1, "industrial");
  const auto ordered = order_segments(drive.recording, {}, {}, 0);
  ASSERT_TRUE(ordered);
  const MovingPhases table = moving_phases(ordered->motion);
  EXPECT_THAT(table.rank, testing::ElementsAre(0, 1, 2, 3, 4));
  EXPECT_TRUE(has_same_parents(table, ordered->tree));
}

/// "ins0-ins1": parent and child of each joint in an independent simulator's ground truth.
std::vector<std::string> true_edges(const fs::path& folder) {
  std::ifstream file(folder / "truth.json");
  const nlohmann::json truth = nlohmann::json::parse(file);
  std::vector<std::string> list;
  for (const auto& joint : truth.at("joints"))
    list.push_back(fmt::format("ins{}-ins{}", joint.at("parent_ins").get<int>(), joint.at("child_ins").get<int>()));
  return list;
}

TEST(SegmentTree, IsRightWithAMarginOnFaultlessRecordingsOfAnIndependentSimulator) {
  const char* root = std::getenv("KINFER_CASES");
  if (!root) GTEST_SKIP() << "KINFER_CASES is not set";
  for (const char* name : {"excavator_paper_noise", "excavator_general_industrial", "excavator_all_joints_30s",
                           "magnetic_trouble", "two_limbs"}) {
    const fs::path folder = fs::path(root) / "identify" / name;
    if (!fs::exists(folder / "imu.csv")) continue;
    const auto recording = read_ins_csv(folder / "imu.csv");
    ASSERT_TRUE(recording);
    const auto ordered = order_segments(*recording, {}, {}, 0);
    EXPECT_THAT(edges(ordered->tree, ordered->motion), testing::UnorderedElementsAreArray(true_edges(folder))) << name;
    EXPECT_GT(ordered->tree.margin, 2.0) << name;
  }
}

TEST(SegmentTree, IsRightWithAMarginOnAMeasuredChainWithASphericalJointAndCompliantMounts) {
  const char* root = std::getenv("KINFER_DATA");
  if (!root) GTEST_SKIP() << "KINFER_DATA is not set";
  for (const char* mounts : {"rigid.csv", "nonrigid.csv"}) {
    const auto recording = read_ins_csv(fs::path(root) / "diodem_chain5" / "trial1" / mounts);
    ASSERT_TRUE(recording);
    const auto ordered = order_segments(*recording, {}, "seg1", 0);
    EXPECT_THAT(edges(ordered->tree, ordered->motion),
                testing::UnorderedElementsAre("seg1-seg2", "seg2-seg3", "seg3-seg4", "seg4-seg5"));
    EXPECT_GT(ordered->tree.margin, 2.0) << mounts;
  }
}

TEST(Identify, FindsTheFirstLinksOfThePapersExcavator) {
  const DrivenMachine drive = driven_machine("excavator", {}, Script::standard, 1);
  const IdentifyOptions options{.engine = BacterialProgramming{.terminals = JointVariableKind::euler},
                                .links = 2,
                                .geometry = GeometrySource::searched};
  const auto found = identify_machine(drive.recording, options, Rng(1));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->joints.size(), 2u);
  EXPECT_EQ(found->root, drive.truth.root);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(angle_between(found->joints[i].axis_in_child, drive.truth.joints[i].axis_in_child), 0.05) << i;
    EXPECT_LT(line_error(found->joints[i], drive.truth.joints[i]), 0.1) << i;
  }
  EXPECT_EQ(found->dh.size(), 6u);
  EXPECT_EQ(dof(found->chain), 2);
  EXPECT_EQ(found->searches.front().best.size(), 301u);
  EXPECT_LT(found->searches.front().holdout.total, 1.5 * found->searches.front().fitted.total);
}

TEST(Identify, ATrajectoryHasARowForEachVariableOfTwoBodiesThatAreNoMachine) {
  const char* root = std::getenv("KINFER_DATA");
  if (!root) GTEST_SKIP() << "KINFER_DATA is not set";
  const fs::path file = fs::path(root) / "odd_ins_logs" / "head_chest_bicycle_20s.csv";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is missing";
  const auto recording = read_ins_csv(file);
  ASSERT_TRUE(recording);
  const auto found = identify_machine(*recording, {.threads = 1}, Rng(1));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->joints.size(), 1u);
  // A universal joint moved through large angles: one half of it must not be relaxed to a spherical joint.
  EXPECT_EQ(found->joints[0].trajectory.rows(), dof(found->chain));
  EXPECT_EQ(found->motion.trajectory.q.rows(), dof(found->chain));
}

TEST(Identify, AHingeStaysOneWhereConsumerSensorsNeverRest) {
  for (const std::uint64_t seed : test::repeats({1, 2, 3, 4})) {
    DrivenMachine drive = test::first_sensors(
        test::driven_machine("crane", seed, Script::together, {.mounting = Mounting::arbitrary}, "consumer"), 3);
    drive.recording = within(drive.recording, 6.0, 30.0);
    const Identification found = test::identified(drive.recording);
    EXPECT_EQ(found.joints.size(), 2);
    for (const JointEstimate& joint : found.joints) EXPECT_EQ(joint.type, EstimatedJointType::revolute) << seed;
  }
}

TEST(Identify, GivesTheSameBitsForAnyNumberOfThreads) {
  const DrivenMachine drive = driven_machine("excavator", {}, Script::standard, 1);
  const auto run = [&](int threads) {
    return *identify_machine(drive.recording, {.links = 2, .threads = threads}, Rng(4));
  };
  const Identification one = run(1);
  for (const int threads : {2, 7}) {
    const Identification many = run(threads);
    for (std::size_t i = 0; i < one.searches.size(); ++i) {
      EXPECT_EQ(one.searches[i].best, many.searches[i].best);
      EXPECT_EQ(one.searches[i].median, many.searches[i].median);
      EXPECT_EQ(one.joints[i].point_in_child, many.joints[i].point_in_child);
    }
  }
}

TEST(Identify, ReportsWhatARecordingLeavesUnobservable) {
  DrivenMachine drive = driven_machine("excavator", {}, Script::standard, 1);
  InsRecording one = drive.recording, still = drive.recording;
  one.sensors.resize(1);
  EXPECT_THAT(identify_machine(one, {}, Rng(1)).error().what, testing::HasSubstr("at least two sensors"));
  still.sensors[3] = still.sensors[0];
  still.sensors[3].name = "lazy";
  const auto lazy = identify_machine(still, {}, Rng(1));
  ASSERT_TRUE(lazy);
  EXPECT_EQ(lazy->findings.front().kind, FindingKind::idle);
  EXPECT_THAT(words::identification_verdict(*lazy), testing::HasSubstr("ins0, lazy never move"));
  EXPECT_THAT(identify_machine(drive.recording, {.root = "nobody"}, Rng(1)).error().what,
              testing::HasSubstr("no such sensor"));
}

TEST(Identify, UsesASecondSensorOnOneSegmentAndReportsIt) {
  DrivenMachine drive = driven_machine("excavator", {}, Script::standard, 1);
  InsSensor second = drive.recording.sensors[5];
  second.name = "second";
  drive.recording.sensors.push_back(second);
  const auto found = identify_machine(drive.recording, {}, Rng(1));
  ASSERT_TRUE(found);
  const auto rigid = std::ranges::find(found->joints, EstimatedJointType::rigid, &JointEstimate::type);
  ASSERT_NE(rigid, found->joints.end());
  EXPECT_LT(rigid->point_in_parent.norm(), 0.01);
  EXPECT_THAT(words::identification_verdict(*found), testing::HasSubstr("never moved"));
}

}  // namespace
}  // namespace kinfer
