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

/// The child rotates about two axes: about one of the parent's before the split, about its own after it, while the
/// parent rests.
RecordedMotion one_axis_after_the_other() {
  constexpr double period = 0.01, rate = 0.3;
  std::vector<FrameState> parent = test::freely_moving(), child = parent;
  for (std::size_t row = 0; row < parent.size(); ++row) {
    const bool is_after = row >= split_row;
    if (is_after) parent[row] = {.rotation = parent[split_row - 1].rotation};
    const double before = rate * period * static_cast<double>(std::min(row, split_row)),
                 after = rate * period * static_cast<double>(row) - before;
    child[row] = parent[row];
    child[row].rotation = parent[row].rotation * rot_z(before) * rot_x(after);
    child[row].angular_velocity += rate * (is_after ? child[row].rotation.col(0) : parent[row].rotation.col(2));
  }
  return test::recorded_motion({test::measured_segment("parent", parent), test::measured_segment("child", child)});
}

/// Least residual with another axis in the parent, before and after the split, over that of a child which is remounted.
std::array<double, 2> part_across(const RecordedMotion& motion) {
  const auto rows = test::all_rows(motion.rows());
  const RelationRows child = relation_rows(motion.segments[1], rows, gyro_relation, relation_gravity),
                     parent = relation_rows(motion.segments[0], rows, gyro_relation, relation_gravity);
  const PairRelation relation(child, parent, gyro_relation);
  const SplitFit constant = relation.fit(split_row, {}), own = relation.fit(split_row, {.first = true});
  EXPECT_GT(constant.rms, 10.0 * own.rms);
  return {relation.rms_across(own, split_row, 0) / own.rms, relation.rms_across(own, split_row, 1) / own.rms};
}

TEST(PairRelation, ANeighbourThatRestsDoesNotTellARemountingFromASecondAxis) {
  const auto [before, after] = part_across(one_axis_after_the_other());
  EXPECT_GT(before, 10.0);
  EXPECT_LT(after, 1.5) << "any axis of a parent at rest leaves the same";
  const auto [moving_before, moving_after] =
      part_across(remounted_pair({exp_so3(Vec3(0.2, -0.3, 0.25)), Vec3::Zero()}));
  EXPECT_GT(moving_before, 10.0);
  EXPECT_GT(moving_after, 10.0);
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
