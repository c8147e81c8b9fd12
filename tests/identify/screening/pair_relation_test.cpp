// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/pair_relation.hpp"

#include <gtest/gtest.h>

#include "identify/measured_segments.hpp"
#include "kinfer/identify/screening/remount.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer {
using namespace identify;
namespace {

constexpr double relation_gravity = 9.81;
constexpr std::size_t split_row = 300;

/// A revolute joint on a freely moving parent; the child's sensor is mounted anew by `old_T_new` at the split.
RecordedMotion remounted_pair(const Pose& old_T_new = {}) {
  const auto parent = test::freely_moving();
  auto child = propagate(parent, test::general_hinge(), test::three_signals());
  for (std::size_t row = split_row; row < child.size(); ++row) {
    FrameState& s = child[row];
    const Vec3 arm = s.rotation * old_T_new.position;
    s.acceleration += s.angular_acceleration.cross(arm) + s.angular_velocity.cross(s.angular_velocity.cross(arm));
    s.rotation = s.rotation * old_T_new.rotation;
  }
  return test::recorded_motion({test::measured_segment("parent", parent), test::measured_segment("child", child)});
}

SplitFit split_fit(const RecordedMotion& motion, const MountRelation& relation, SplitSensors split) {
  const auto rows = test::all_rows(motion.rows());
  const RelationRows a = relation_rows(motion.segments[0], rows, relation, relation_gravity),
                     b = relation_rows(motion.segments[1], rows, relation, relation_gravity);
  return PairRelation(a, b, relation).fit(split_row, split);
}

JointGeometry true_geometry() {
  return fit_revolute_geometry(test::general_hinge(), {{{-0.6}, {0}, {0}}, {{0.1}, {0}, {0}}, {{0.9}, {0}, {0}}});
}

TEST(PairRelation, OfTheGyrosFindsTheAxisInBothSensorsWithoutOrientations) {
  const SplitFit fit = split_fit(remounted_pair(), gyro_relation, {});
  EXPECT_LT(fit.rms, 1e-3);
  EXPECT_LT(fit.p[0][0].cross(true_geometry().axis_in_parent).norm(), 5e-3);
  EXPECT_LT(fit.p[1][0].cross(true_geometry().axis_in_child).norm(), 5e-3);
  EXPECT_EQ(fit.p[0][0], fit.p[0][1]) << "one mounting before and after";
}

TEST(PairRelation, OfTheAccelerometersFindsAPointOfTheAxis) {
  const SplitFit fit = split_fit(remounted_pair(), force_relation, {});
  const JointGeometry truth = true_geometry();
  EXPECT_LT(fit.rms, 0.02);
  EXPECT_LT((fit.p[0][0] - truth.point_in_parent).cross(truth.axis_in_parent).norm(), 0.03);
  EXPECT_LT((fit.p[1][0] - truth.point_in_child).cross(truth.axis_in_child).norm(), 0.03);
}

TEST(PairRelation, ARotatedSensorBreaksTheRelationUnlessItMayDifferAtTheSplit) {
  const Mat3 turn = exp_so3(Vec3(0.2, -0.3, 0.25));
  const RecordedMotion motion = remounted_pair({turn, Vec3::Zero()});
  const SplitFit constant = split_fit(motion, gyro_relation, {}),
                 other = split_fit(motion, gyro_relation, {.first = true}),
                 right = split_fit(motion, gyro_relation, {.second = true});
  EXPECT_LT(right.rms, 1e-3);
  EXPECT_GT(constant.rms, 20.0 * right.rms);
  EXPECT_GT(other.rms, 5.0 * right.rms) << "the parent was not remounted";
  EXPECT_LT(right.p[1][1].cross(turn.transpose() * right.p[1][0]).norm(), 5e-3) << "old_T_new turns the axis";
}

TEST(PairRelation, AShiftedSensorChangesTheForceRelationAlone) {
  const Vec3 shift(0.2, 0.1, -0.3);
  const RecordedMotion motion = remounted_pair({Mat3::Identity(), shift});
  EXPECT_LT(split_fit(motion, gyro_relation, {}).rms, 1e-3);
  const SplitFit constant = split_fit(motion, force_relation, {}),
                 right = split_fit(motion, force_relation, {.second = true});
  EXPECT_GT(constant.rms, 5.0 * right.rms);
  const Vec3 moved = right.p[1][0] - right.p[1][1], axis = true_geometry().axis_in_child;
  EXPECT_LT((moved - shift).cross(axis).norm(), 0.04) << "the point moves the other way in the sensor's frame";
}

TEST(RemountFinding, NamesTheSensorTheTimeAndThePartThatIsUsed) {
  const RecordedMotion motion = remounted_pair();
  Remount remount{.segment = 1, .begin = 2.0, .end = 3.5, .axis_rotation = 0.2, .point_shift = 0.1};
  const Finding after = finding_about(remount, motion);
  remount.before_is_more_informative = true;
  const Finding before = finding_about(remount, motion);
  EXPECT_EQ(after.kind, FindingKind::remounted);
  EXPECT_TRUE(after.applied);
  EXPECT_EQ(after.values.text("sensor"), "child");
  EXPECT_EQ(after.values.text("used_part"), "after");
  EXPECT_EQ(before.values.text("used_part"), "before");
  EXPECT_NE(words::sentence(before), words::sentence(after));
}

}  // namespace
}  // namespace kinfer
