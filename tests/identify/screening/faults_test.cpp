// SPDX-License-Identifier: Apache-2.0
// Faulty recordings: each fault is found and reported, and the rest of the machine is as accurate as possible.
#include <gmock/gmock.h>

#include "identify/driven_machine.hpp"
#include "kinfer/identify/pipeline.hpp"
#include "kinfer/identify/screening/remount.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/simulate/four_bar_linkage.hpp"
#include "kinfer/simulate/log_faults.hpp"
#include "kinfer/words/identification/verdict.hpp"
#include "repeats.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::driven_machine;
using test::DrivenMachine;
using test::has_finding;
using test::identified;
using test::worst_line_error;

/// The excavator at seed 3, the given sensor remounted after `seconds`.
DrivenMachine remounted(std::size_t sensor, double seconds, const Pose& old_T_new) {
  const MujocoWorld world = test::world_of("excavator-general", {}, 3);
  MachineMotion motion = world.prescribe(test::drive_of(world.machine(), {}, 3), 100.0);
  const MachineTruth truth = machine_truth(world.machine(), motion);
  motion = with_remount(std::move(motion), sensor, static_cast<std::size_t>(100.0 * seconds), old_T_new);
  return {simulate_recording(world.machine(), motion, *sensor_grade("industrial"), {}, Rng(3)), truth};
}

struct RemountCase {
  std::size_t sensor;
  double seconds;
  Vec3 turn;       // [rad]
  Vec3 shift;      // [m]
  double longest;  // [s] span in which that segment does not move, and a little more
};

class EveryRemount : public testing::TestWithParam<RemountCase> {};
INSTANTIATE_TEST_SUITE_P(Remount, EveryRemount,
                         testing::Values(RemountCase{3, 41.0, {0.2, 0.3, 0.1}, {0.0, 0.0, 0.0}, 1.0},
                                         RemountCase{5, 40.0, {0.0, 0.1, 0.15}, {0.1, 0.0, -0.2}, 3.0},
                                         RemountCase{4, 38.0, {0.0, 0.0, 0.0}, {0.3, 0.2, 0.2}, 12.0}));

TEST_P(EveryRemount, IsFoundWithSensorAndTime) {
  const auto& [sensor, seconds, turn, shift, longest] = GetParam();
  const DrivenMachine drive = remounted(sensor, seconds, {exp_so3(turn), shift});
  const auto ordered = order_segments(drive.recording, {}, {}, 0);
  ASSERT_TRUE(ordered);
  const auto found = find_remount(*ordered, 0);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->segment, sensor);
  EXPECT_LT(found->begin, seconds);
  EXPECT_GT(found->end, seconds);
  EXPECT_LT(found->end - found->begin, longest);
}

TEST(Remount, TheMoreInformativeSideIsUsedAndReported) {
  const DrivenMachine drive = remounted(3, 41.0, {exp_so3(Vec3(0.2, 0.3, 0.1)), Vec3::Zero()});
  const Identification found = identified(drive.recording);
  EXPECT_TRUE(has_finding(found, "remounted", "ins3"));
  EXPECT_LT(worst_line_error(found.joints, drive.truth), 10e-3);
}

TEST(Remount, IsNotReportedWhereNoSensorWasMoved) {
  for (const std::string& name : machine_names())
    for (const Script script : test::repeats({Script::standard, Script::gentle})) {
      const auto ordered = order_segments(driven_machine(name, 4, script).recording, {}, {}, 0);
      ASSERT_TRUE(ordered);
      EXPECT_FALSE(find_remount(*ordered, 0)) << name;
    }
}

TEST(GivenTree, ThatContradictsTheRecordingIsReportedByName) {
  const DrivenMachine drive = test::driven_arm(3, 5);
  const Identification found =
      identified(drive.recording, {.tree = {{"ins0", "ins1"}, {"ins1", "ins3"}, {"ins3", "ins2"}, {"ins2", "ins4"}}});
  EXPECT_EQ(found.usability, Usability::do_not_use);
  EXPECT_TRUE(has_finding(found, "given_link", "ins1-ins3"));
  EXPECT_TRUE(has_finding(found, "given_link", "ins2-ins4"));
  EXPECT_FALSE(has_finding(found, "given_link", "link ins0-ins1"));
  EXPECT_THAT(words::identification_verdict(found), testing::StartsWith("Do not use"));
}

TEST(GivenTree, ThatEqualsTheEstimatedTreeChangesNothing) {
  const DrivenMachine drive = test::driven_arm(3, 4);
  IdentifyOptions options;
  for (const JointTruth& joint : drive.truth.joints) options.tree.push_back({joint.child, joint.parent});
  const Identification own = identified(drive.recording), given = identified(drive.recording, options);
  EXPECT_NE(given.usability, Usability::do_not_use);
  EXPECT_TRUE(given.findings.empty());
  for (std::size_t j = 0; j < own.joints.size(); ++j)
    EXPECT_EQ(own.joints[j].point_in_child, given.joints[j].point_in_child);
}

TEST(GivenTree, ThatIsNoTreeIsRefused) {
  const DrivenMachine drive = driven_machine("excavator-general", 3, Script::together);
  const auto refused = [&](const std::vector<GivenLink>& tree) {
    const auto found = identify_machine(drive.recording, {.tree = tree}, Rng(1));
    return found ? std::string() : found.error().what;
  };
  EXPECT_THAT(refused({{"ins0", "nobody"}}), testing::HasSubstr("no such sensor"));
  EXPECT_THAT(refused({{"ins0", "ins1"}}), testing::HasSubstr("6 sensors need 5"));
  EXPECT_THAT(refused({{"ins0", "ins1"}, {"ins1", "ins0"}, {"ins2", "ins3"}, {"ins3", "ins4"}, {"ins4", "ins5"}}),
              testing::HasSubstr("form a loop"));
}

TEST(TwoMachines, OnMovingBasesAreSeparatedAndTheLargerIsIdentified) {
  const MachineOptions rocking{.mounting = Mounting::arbitrary, .base = Base::rocking};
  const DrivenMachine crane = test::first_sensors(driven_machine("crane", 5, Script::together, rocking), 3),
                      excavator = test::driven_arm(4, 4, Script::together, rocking);
  const Identification found = identified(merge_recordings(excavator.recording, crane.recording, "crane_"));
  EXPECT_EQ(found.joints.size(), excavator.truth.joints.size());
  EXPECT_TRUE(has_finding(found, "several_machines", "crane_ins0, crane_ins1"));
  for (const JointEstimate& joint : found.joints) EXPECT_THAT(joint.child, testing::Not(testing::HasSubstr("crane")));
  EXPECT_THAT(words::identification_verdict(found), testing::HasSubstr("crane_ins1"));
  std::vector<std::string> names;
  for (const InsSensor& sensor : crane.recording.sensors) names.push_back("crane_" + sensor.name);
  const Identification other =
      identified(merge_recordings(excavator.recording, crane.recording, "crane_"), {.sensors = names});
  EXPECT_EQ(other.joints.size(), crane.truth.joints.size());
}

TEST(TwoMachines, OnTheSameGroundAreIdentifiedTogetherAndReported) {
  const DrivenMachine crane = test::first_sensors(driven_machine("crane", 5, Script::together), 3),
                      excavator = test::driven_arm(4, 4);
  const Identification found = identified(merge_recordings(excavator.recording, crane.recording, "crane_"));
  EXPECT_TRUE(has_finding(found, "idle", "ins0, crane_ins0"));
  EXPECT_TRUE(has_finding(found, "several_machines", "share only the ground"));
  EXPECT_TRUE(std::ranges::none_of(found.findings, [](const Finding& f) { return f.kind == FindingKind::clock; }))
      << "nothing tells the time between the two";
  EXPECT_LT(worst_line_error(found.joints, excavator.truth), 6e-3);
}

double distance_to_line(const Vec3& point, const Vec3& truth, const Vec3& axis) {
  return (point - truth).cross(axis).norm();
}

/// In a parallelogram, coupler and carrier never rotate against each other, nor do crank and rocker.
TEST(Linkage, BarsThatNeverTurnAgainstEachOtherAreNoNeighbours) {
  for (const auto& [script, grade] : {std::pair{Script::standard, "consumer"},
                                      {Script::sequential, "industrial"},
                                      {Script::gentle, "industrial"},
                                      {Script::quick, "consumer"}}) {
    const MujocoWorld world = test::world_of("excavator", {.mounting = Mounting::arbitrary}, 16);
    const Machine machine = with_linkage(world.machine());
    const MachineMotion motion =
        linkage_motion(machine, test::drive_of(world.machine(), {.script = script}, 16), 100.0);
    const MachineTruth truth = machine_truth(machine, motion);
    const auto ordered =
        order_segments(simulate_recording(machine, motion, *sensor_grade(grade), {}, Rng(16)), {}, truth.root, 0);
    ASSERT_TRUE(ordered) << ordered.error().what;
    std::vector<JointTruth> bars = truth.joints;
    bars.insert(bars.end(), truth.loops.begin(), truth.loops.end());
    const auto& segments = ordered->motion.segments;
    for (std::size_t s = 0; s < segments.size(); ++s) {
      if (!ordered->tree.parent[s]) continue;
      const std::string &one = segments[s].name, &other = segments[*ordered->tree.parent[s]].name;
      EXPECT_TRUE(std::ranges::any_of(bars,
                                      [&](const JointTruth& j) {
                                        return (j.parent == one && j.child == other) ||
                                               (j.parent == other && j.child == one);
                                      }))
          << one << " " << other << " " << grade;
    }
  }
}

TEST(Linkage, ItsLoopIsFoundAndTheRestOfTheChainIsAsAccurateAsWithout) {
  for (const std::uint64_t seed : test::repeats({2u, 3u})) {
    const MujocoWorld world = test::world_of("excavator", {.mounting = Mounting::arbitrary}, seed);
    const Drive drive = test::drive_of(world.machine(), {.script = Script::together}, seed);
    const Machine machine = with_linkage(world.machine());
    const MachineMotion motion = linkage_motion(machine, drive, 100.0);
    const InsRecording recording = simulate_recording(machine, motion, *sensor_grade("industrial"), {}, Rng(seed));
    const Identification found = identified(recording);
    EXPECT_TRUE(has_finding(found, "loop", "ins4, ins5, rocker, coupler"));
    MachineTruth arm = machine_truth(machine, motion);
    ASSERT_EQ(found.loops.size(), 1U);
    const JointEstimate& closing = found.loops[0].joint;
    std::vector<JointTruth> bars = arm.joints;
    bars.insert(bars.end(), arm.loops.begin(), arm.loops.end());
    const auto truth = std::ranges::find_if(bars, [&](const JointTruth& j) {
      return (j.parent == closing.parent && j.child == closing.child) ||
             (j.parent == closing.child && j.child == closing.parent);
    });
    ASSERT_NE(truth, bars.end()) << closing.parent << " " << closing.child;
    if (truth->parent != closing.parent) {
      std::swap(truth->point_in_parent, truth->point_in_child);
      std::swap(truth->axis_in_parent, truth->axis_in_child);
    }
    EXPECT_LT(distance_to_line(closing.point_in_parent, truth->point_in_parent, truth->axis_in_parent), 8e-3);
    EXPECT_LT(distance_to_line(closing.point_in_child, truth->point_in_child, truth->axis_in_child), 8e-3);
    EXPECT_LT(closing.axis_in_parent.cross(truth->axis_in_parent).norm(), 5e-3);
    EXPECT_LT(closing.axis_in_child.cross(truth->axis_in_child).norm(), 5e-3);
    ASSERT_EQ(found.chain.closures.size(), 1U);
    const auto frames = joint_frames(found.chain, VectorXd::Zero(dof(found.chain)));
    const LoopClosure& closure = found.chain.closures[0];
    const auto frame = [&](int joint) {
      return joint < 0 ? found.chain.base.pose() : frames[static_cast<std::size_t>(joint)];
    };
    EXPECT_LT((frame(closure.first) * closure.point_in_first - frame(closure.second) * closure.point_in_second).norm(),
              5e-3)
        << "the chain closes where the recording begins";
    std::erase_if(arm.joints,
                  [](const JointTruth& j) { return j.child != "ins2" && j.child != "ins3" && j.child != "ins4"; });
    EXPECT_LT(worst_line_error(found.joints, arm), 5e-3);
  }
}

}  // namespace
}  // namespace kinfer
