// SPDX-License-Identifier: Apache-2.0
// After a collision or a motor change: few poses and the earlier calibration.
#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

/// A robot calibrated with 50 poses, whose third motor was changed and tracker moved afterwards.
struct Knocked {
  Chain truth = with_random_errors(nominal_robot(), {}, Rng(3));
  Chain earlier =
      calibrate_robot({nominal_robot(), {}, tracker, measured(truth, paper2_poses(50, tracker))}, {}, Rng(1))
          ->estimate.chain;
  Chain now = truth;

  Knocked() {
    std::get<MdhLink>(now.joints[2].link).theta += 0.7 * degree;
    now.base = Frame::from_pose(Pose::from_xyz_rpy({0.8, -1.5, 0.2}, {0.01, 0.0, 1.1}));
  }

  Calibration refit(int count) const {
    const CalibrationTask task{.nominal = nominal_robot(),
                               .instrument = tracker,
                               .data = measured(now, paper2_poses(count, tracker), 8),
                               .earlier = earlier};
    return calibrate_robot(task, {.parameters = JointOffsetParameters{}}, Rng(1)).value();
  }
  double error(const Chain& chain) const {
    return mean(point_errors(chain, measured(now, paper2_poses(200, noise_free), 99)));
  }
};

TEST(OffsetRefit, EightPosesFindTheOnlyOffsetThatChanged) {
  const Knocked robot;
  const Calibration c = robot.refit(8);
  EXPECT_EQ(c.usability, Usability::use) << words::verdict(c);
  EXPECT_LT(robot.error(c.estimate.chain), 80e-6);
  EXPECT_GT(c.before.position.holdout.mean, 1e-3);
  std::vector<CalibrationNote> moved = c.notes;
  std::erase_if(moved, [](const CalibrationNote& n) { return n.kind != CalibrationNoteKind::joint_offset_moved; });
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_EQ(moved[0].values.text("parameter"), "theta3");
  EXPECT_NEAR(moved[0].values.number("change_rad"), 0.7 * degree, 0.05 * degree);
}

TEST(Refit, FewPosesAreHeldOutOneAtATime) {
  const Knocked robot;
  const Calibration c = robot.refit(8);
  ASSERT_TRUE(std::holds_alternative<HoldoutFolds>(c.holdout));
  EXPECT_EQ(std::get<HoldoutFolds>(c.holdout).folds, 8);
  EXPECT_EQ(c.after.position.holdout.n, 8);
}

TEST(Refit, AnEarlierCalibrationOfAnotherRobotIsRefused) {
  Chain other = nominal_robot();
  other.joints.pop_back();
  const CalibrationTask task{.nominal = nominal_robot(),
                             .instrument = tracker,
                             .data = measured(nominal_robot(), paper2_poses(10, tracker)),
                             .earlier = other};
  EXPECT_EQ(calibrate_robot(task, {.parameters = JointOffsetParameters{}}, Rng(1)).error().what,
            "expected an earlier calibration of this kind of robot (6 joints of the same types)");
}

TEST(OffsetRefit, IsBetterThanANewCalibrationWithAsFewPoses) {
  const Knocked robot;
  const auto anew = calibrate_robot({nominal_robot(), {}, tracker, measured(robot.now, paper2_poses(8, tracker), 8)},
                                    {.model = FixedModel{}}, Rng(1));
  ASSERT_TRUE(anew.has_value());
  EXPECT_LT(robot.error(robot.refit(8).estimate.chain), 0.5 * robot.error(anew->estimate.chain));
}

TEST(OffsetRefit, AnUnchangedRobotIsReportedAsUnchanged) {
  Knocked robot;
  robot.now = robot.truth;
  const Calibration c = robot.refit(8);
  const auto says_so = [](const CalibrationNote& n) { return n.kind == CalibrationNoteKind::no_offset_moved; };
  EXPECT_TRUE(std::any_of(c.notes.begin(), c.notes.end(), says_so));
  EXPECT_EQ(c.reason, CalibrationReason::unchanged) << words::verdict(c);
  EXPECT_EQ(c.usability, Usability::use);
}

}  // namespace
}  // namespace kinfer
