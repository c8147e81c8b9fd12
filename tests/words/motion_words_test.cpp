// SPDX-License-Identifier: Apache-2.0
// Sentences about reach targets, paths, and robot files that were written back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "kinfer/base/angle.hpp"
#include "kinfer/words/calibration/model_patch.hpp"
#include "kinfer/words/language.hpp"
#include "kinfer/words/motion/path.hpp"
#include "kinfer/words/motion/reach.hpp"

namespace kinfer {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ReachWords, CountTheTargetsThatAreReached) {
  ReachSummary summary{.targets = 60};
  EXPECT_EQ(words::summary(summary), "60 of 60 targets are reached");
  summary.unreached.resize(2);
  EXPECT_EQ(words::summary(summary), "58 of 60 targets are reached");
}

TEST(ReachWords, EveryReasonIsToldWithWhatIsLeft) {
  std::set<std::string> sentences;
  for (const ReachStatus status :
       {ReachStatus::reached, ReachStatus::outside_limits, ReachStatus::near_singular, ReachStatus::out_of_reach}) {
    ReachSolution solution;
    solution.status = status;
    solution.position_error = 0.412, solution.angle_error = 0.5 * degree;
    solution.limited_joints = {1};
    const std::string text = words::unreached_target(3, solution, {"J1", "J2", "J3"});
    EXPECT_TRUE(text.starts_with("target 3: ")) << text;
    EXPECT_TRUE(text.ends_with("; 412.0000 mm and 0.5000 deg are left")) << text;
    EXPECT_EQ(text.find("J2") != std::string::npos, status == ReachStatus::outside_limits) << text;
    EXPECT_TRUE(sentences.insert(text).second) << text;
  }
}

TEST(ReachWords, SeveralJointsBeyondTheirLimitsAreInThePlural) {
  ReachSolution solution;
  solution.status = ReachStatus::outside_limits;
  solution.limited_joints = {0};
  EXPECT_THAT(words::unreached_target(1, solution, {"A", "B"}), HasSubstr("only with A beyond its limits"));
  solution.limited_joints = {0, 1};
  EXPECT_THAT(words::unreached_target(1, solution, {"A", "B"}), HasSubstr("only with A, B beyond their limits"));
}

TEST(PathWords, CornersAreCutInTheUnitOfTheJoints) {
  PathResult result;
  TimedPath& path = result.path;
  path.duration = 4.312, path.passing_times = {0, 1, 2, 3, 4};
  EXPECT_EQ(words::summary(result, {true, true}), "4.312 s, 5 waypoints");
  path.cuts = {0.5, 2.0};
  EXPECT_THAT(words::summary(result, {true, true}), HasSubstr("by up to 2.00 deg of a joint"));
  path.cuts = {1.0, 12.3};
  EXPECT_THAT(words::summary(result, {false, false}), HasSubstr("by up to 12.3 mm of a joint"));
  EXPECT_THAT(words::summary(result, {false, true}), HasSubstr("by up to 12.30 deg or mm of a joint"));
}

TEST(PathWords, JointsThatSlowThePathDownAreNamedOnlyWhereTheyDo) {
  PathResult result;
  TimedPath& path = result.path;
  path.duration = 2.0;
  EXPECT_THAT(words::summary(result, {true}), Not(HasSubstr("at their limits")));
  path.slowed_by = 1.5;
  EXPECT_THAT(words::summary(result, {true}), HasSubstr("1.50 times as long as the tool alone needs"));
}

TEST(PathWords, WaypointsAreThoseThatAreMet) {
  PathResult result;
  result.path.duration = 2.0, result.path.passing_times = {0, 1};
  result.targets.resize(4);  // out of reach, all of them
  EXPECT_EQ(words::summary(result, {true}), "2.000 s, 0 of 4 waypoints");
  result.targets[0].status = result.targets[3].status = ReachStatus::reached;
  EXPECT_EQ(words::summary(result, {true}), "2.000 s, 1 of 4 waypoints") << "the path ends before the last";
}

TEST(PathWords, ObstaclesCountLinesFromOne) {
  PathObstacle obstacle{.kind = PathObstacle::Kind::outside_limits, .time = 1.24, .line = 1, .joint = 2};
  EXPECT_EQ(words::sentence(obstacle, {"J1", "J2", "J3"}), "line 2, 1.240 s: J3 leaves its limits");
  std::set<std::string> sentences;
  for (const auto kind :
       {PathObstacle::Kind::outside_limits, PathObstacle::Kind::near_singular, PathObstacle::Kind::not_reached}) {
    obstacle.kind = kind;
    sentences.insert(words::sentence(obstacle, {"J1", "J2", "J3"}));
  }
  EXPECT_EQ(sentences.size(), 3u);
}

ModelPatch patch_with(std::size_t changes) {
  ModelPatch patch;
  patch.file = "robot_calibrated.urdf";
  patch.changes.resize(changes);
  return patch;
}

TEST(ModelPatchWords, CountJointsAndThoseThatWereAdded) {
  EXPECT_EQ(words::headline(patch_with(1)),
            "robot_calibrated.urdf is your file with the origins of 1 joint changed and every other byte kept.");
  ModelPatch patch = patch_with(6);
  patch.changes[4].inserted = patch.changes[5].inserted = true;
  EXPECT_THAT(words::headline(patch), HasSubstr("6 joints changed (2 added) and"));
}

TEST(ModelPatchWords, EveryNumberThatTheFileCannotHoldIsNamedWithItsEffect) {
  ModelPatch patch = patch_with(6);
  const std::size_t without = words::remarks(patch).size();
  std::set<std::string> sentences;
  for (int i = 0; i <= static_cast<int>(NonGeometricKind::expansion); ++i)
    for (const bool depends_on_load : {false, true}) {
      patch.omitted = {{.kind = static_cast<NonGeometricKind>(i),
                        .joints = 3,
                        .rms = 1.25e-4,
                        .max = 3.5e-4,
                        .depends_on_load = depends_on_load}};
      const auto remarks = words::remarks(patch);
      ASSERT_EQ(remarks.size(), without + 2) << "what is left out, and how to do without it";
      const std::string& text = remarks[without];
      EXPECT_TRUE(sentences.insert(text).second) << text;
      EXPECT_EQ(text.find("0.125 mm rms and at most 0.350 mm") != std::string::npos, !depends_on_load) << text;
    }
  patch.omitted.push_back(patch.omitted.front());
  patch.omitted_rms = 2e-4, patch.omitted_max = 5e-4;
  EXPECT_THAT(words::remarks(patch), ::testing::Contains(HasSubstr("0.200 mm rms, at most 0.500 mm")));
}

TEST(ModelPatchWords, SeparateOffsetsMustBeAddedByTheUser) {
  ModelPatch patch = patch_with(6);
  const auto folded = words::remarks(patch);
  patch.offsets = EncoderOffsets::separate;
  const auto separate = words::remarks(patch);
  ASSERT_EQ(separate.size(), folded.size() + 1);
  EXPECT_THAT(separate.front(), HasSubstr("joint_origins.yaml"));
}

TEST(ModelPatchWords, AnMjcfHasFramesOfJointsAndOffsetsInAFileOfTheirOwn) {
  ModelPatch patch = patch_with(6);
  patch.file = "arm_calibrated.xml", patch.format = RobotFileFormat::mjcf, patch.offsets = EncoderOffsets::separate;
  patch.omitted = {{.kind = NonGeometricKind::gain, .joints = 1}};
  EXPECT_EQ(words::headline(patch),
            "arm_calibrated.xml is your file with the frames of 6 joints changed and every other byte kept.");
  EXPECT_THAT(words::remarks(patch), ::testing::Contains(HasSubstr("joint_offsets.yaml")));
  EXPECT_THAT(words::remarks(patch), ::testing::Not(::testing::Contains(HasSubstr("URDF"))));
}

TEST(MotionWords, InTheLanguageOfNamesTheyAreNames) {
  words::set_language(words::Language::names);
  EXPECT_EQ(words::summary(ReachSummary{.targets = 3}), "reach");
  EXPECT_EQ(words::summary(PathResult{}, {true}), "path");
  EXPECT_EQ(words::sentence(PathObstacle{.kind = PathObstacle::Kind::near_singular}, {}), "near_singular");
  EXPECT_EQ(words::headline(patch_with(2)), "model_patch");
  words::set_language(words::Language::english);
}

}  // namespace
}  // namespace kinfer
