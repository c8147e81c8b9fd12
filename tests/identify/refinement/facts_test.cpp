// SPDX-License-Identifier: Apache-2.0
// Touches, tapes and surveyed points beside a recording of a simulated excavator.
#include <gtest/gtest.h>

#include "kinfer/identify/geometry/link_estimates.hpp"
#include "kinfer/identify/refinement/refine.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/simulate/ground_truth.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "simulate/worlds.hpp"

namespace kinfer {
using namespace identify;
namespace {

const Vec3 tip_in_sensor(1.1, -0.2, 0.35);
constexpr double surveyor_sd = 1e-3;

struct Excavator {
  Machine machine;
  MachineMotion motion;
  InsRecording recording;
};

const Excavator& excavator() {
  static const Excavator example = [] {
    const MujocoWorld world = test::world_of("excavator-general", {}, 4);
    const MachineMotion motion = world.prescribe(test::drive_of(world.machine(), {.script = Script::standard}), 100.0);
    return Excavator{world.machine(), motion,
                     simulate_recording(world.machine(), motion, *sensor_grade("noise"), {}, Rng(4))};
  }();
  return example;
}

/// World coordinates at a row of the motion.
Vec3 true_tip(std::size_t row) {
  const Excavator& e = excavator();
  const MountedSensor& last = e.machine.sensors.back();
  const auto frames = joint_frames(e.machine.chain, e.motion.q.col(static_cast<Eigen::Index>(row)));
  return frames[static_cast<std::size_t>(last.joint)] * (last.segment_T_sensor * tip_in_sensor);
}

Result<Refinement> refined(const MachineMeasurements& facts) {
  const Excavator& e = excavator();
  const auto motion = segment_motion(e.recording);
  const auto tree = segment_tree(*motion, "ins0");
  std::vector<InitialJoint> starts;
  for (std::size_t i = 1; i < tree->order.size(); ++i)
    starts.push_back(estimate_initial_joint(*motion, *tree, *tree->parent[tree->order[i]], tree->order[i],
                                            EstimatedJointType::revolute));
  return refine(e.recording, *motion, *tree, starts, {.facts = facts});
}

HoldSegment around(std::size_t row) {
  const double t = excavator().motion.time[row];
  return {t - 0.01, t + 0.01};
}

MachineMeasurements surveyed_tip() {
  MachineMeasurements facts;
  facts.places.push_back({.name = "tip", .sensor = "ins5", .xyz = {}});
  Rng rng(9);
  for (std::size_t row = 600; row + 200 < excavator().motion.time.size(); row += 350) {
    Vec3 noise;
    for (double& n : noise) n = surveyor_sd * rng.normal();
    facts.surveys.push_back({"tip", around(row), true_tip(row) + noise, surveyor_sd});
  }
  return facts;
}

TEST(Facts, SurveyedPointsLocateTheTipBeyondTheLastSensor) {
  const auto result = refined(surveyed_tip());
  ASSERT_TRUE(result) << result.error().what;
  ASSERT_EQ(result->places.size(), 1U);
  const PointEstimate& tip = result->places[0];
  EXPECT_EQ(tip.sensor, "ins5");
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(std::abs(tip.xyz[i] - tip_in_sensor[i]), 4.0 * tip.sd[i]) << i;
    EXPECT_LT(tip.sd[i], 15e-3) << i;
  }
}

TEST(Facts, ASurveyedPointThatTheOthersContradictIsNamedAndNotUsed) {
  MachineMeasurements facts = surveyed_tip();
  const auto sound = refined(facts);
  ASSERT_TRUE(sound);
  EXPECT_TRUE(
      std::ranges::none_of(sound->findings, [](const Finding& f) { return f.kind == FindingKind::gross_outliers; }));
  facts.surveys[2].xyz.x() += 0.15;
  const auto result = refined(facts);
  ASSERT_TRUE(result) << result.error().what;
  const auto wrong = std::ranges::find(result->findings, FindingKind::gross_outliers, &Finding::kind);
  ASSERT_NE(wrong, result->findings.end());
  EXPECT_EQ(wrong->rows, std::vector<int>{2});
  EXPECT_TRUE(wrong->applied);
  EXPECT_NEAR(wrong->values.number("distance"), 0.15, 0.02);
  const PointEstimate& tip = result->places[0];
  for (int i = 0; i < 3; ++i) EXPECT_LT(std::abs(tip.xyz[i] - tip_in_sensor[i]), 4.0 * tip.sd[i]) << i;
}

/// The distances between neighbouring pins.
MachineMeasurements taped_links(double sd) {
  MachineMeasurements facts;
  for (const LinkTruth& link : machine_truth(excavator().machine, excavator().motion).links)
    facts.tapes.push_back({link.from, link.to, link.length, sd, {}});
  return facts;
}

TEST(Facts, ATapeThatTheRecordingContradictsIsNamedAndNotUsed) {
  MachineMeasurements facts = surveyed_tip();
  facts.tapes = taped_links(2e-3).tapes;
  facts.tapes[1].length += 0.06;
  const auto result = refined(facts);
  ASSERT_TRUE(result) << result.error().what;
  const auto is_outlier = [](const Finding& f) { return f.kind == FindingKind::gross_outliers; };
  ASSERT_EQ(std::ranges::count_if(result->findings, is_outlier), 1);
  const Finding& wrong = *std::ranges::find_if(result->findings, is_outlier);
  EXPECT_EQ(wrong.values.text("facts"), "tapes");
  EXPECT_EQ(wrong.rows, std::vector<int>{1});
  EXPECT_TRUE(wrong.applied);
  EXPECT_NEAR(wrong.values.number("distance"), 0.06, 5e-3);
  const PointEstimate& tip = result->places[0];
  for (int i = 0; i < 3; ++i) EXPECT_LT(std::abs(tip.xyz[i] - tip_in_sensor[i]), 4.0 * tip.sd[i]) << i;
}

TEST(Facts, AFactThatIsNotUsedLeavesNothingBehind) {
  MachineMeasurements facts;
  facts.tapes = {taped_links(2e-3).tapes[0]};
  facts.tapes[0].length *= 10.0;
  const auto with = refined(facts), without = refined({});
  ASSERT_TRUE(with) << with.error().what;
  ASSERT_TRUE(std::ranges::any_of(with->findings, &Finding::applied));
  for (std::size_t i = 0; i < without->joints.size(); ++i) {
    const JointEstimate &a = with->joints[i].estimate, &b = without->joints[i].estimate;
    EXPECT_LT((a.point_in_child - b.point_in_child).norm(), 1e-9) << i;
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(a.sd.point_in_child[k] / b.sd.point_in_child[k], 1.0, 1e-6) << i;
  }
}

/// Largest error of a distance between neighbouring pins [m].
double largest_link_error(const Refinement& refined, const MachineTruth& truth) {
  std::vector<JointEstimate> joints;
  for (const RefinedJoint& joint : refined.joints) joints.push_back(joint.estimate);
  const auto found = link_estimates(joints);
  double largest = 0.0;
  for (const LinkTruth& link : truth.links) {
    const auto same =
        std::ranges::find(found, link.from + link.to, [](const LinkEstimate& l) { return l.from + l.to; });
    EXPECT_NE(same, found.end()) << link.from;
    if (same != found.end()) largest = std::max(largest, std::abs(same->length - link.length));
  }
  return largest;
}

TEST(Facts, ATapeBetweenPinsOutweighsTheSensors) {
  const MachineTruth truth = machine_truth(excavator().machine, excavator().motion);
  constexpr double tape_sd = 5e-5;
  const auto without = refined({}), with = refined(taped_links(tape_sd));
  ASSERT_TRUE(without && with);
  EXPECT_TRUE(with->findings.empty());
  EXPECT_LT(largest_link_error(*with, truth), 4.0 * tape_sd);
  EXPECT_GT(largest_link_error(*without, truth), 6.0 * tape_sd);
}

TEST(Facts, AFactThatDoesNotFitTheMachineIsAnErrorOfOneSentence) {
  const auto complaint = [](const MachineMeasurements& facts) {
    const auto result = refined(facts);
    return result ? "(accepted)" : result.error().what;
  };
  MachineMeasurements unknown;
  unknown.tapes.push_back({"ins1-ins2", "ins9", 1.0, 0.01, {}});
  EXPECT_EQ(complaint(unknown),
            "tape 1: no sensor, joint or [[place]] is called \"ins9\"; the joints are ins0-ins1, ins1-ins2, ins2-ins3, "
            "ins3-ins4, ins4-ins5");
  MachineMeasurements late = surveyed_tip();
  late.surveys[1].at = {1000.0, 1001.0};
  EXPECT_NE(complaint(late).find("point 2: 1000 .. 1001 s: outside the recording"), std::string::npos);
  MachineMeasurements few = surveyed_tip();
  few.surveys.resize(2);
  EXPECT_EQ(complaint(few), "2 surveyed points: at least 3 are needed to place the surveyor's frame");
}

}  // namespace
}  // namespace kinfer
