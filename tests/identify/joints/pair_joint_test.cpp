// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/joints/pair_joint.hpp"

#include <gtest/gtest.h>

#include "identify/measured_segments.hpp"
#include "kinfer/identify/joints/search_links.hpp"
#include "kinfer/words/identification/notes.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::freely_moving;
using test::measured_segment;
using test::three_signals;

/// Moves with the parent, at a fixed pose in its frame.
std::vector<FrameState> carried_by(const std::vector<FrameState>& parent, const Pose& parent_T_child) {
  std::vector<FrameState> child = parent;
  for (FrameState& s : child) {
    const Vec3 arm = s.rotation * parent_T_child.position;
    s.acceleration += s.angular_acceleration.cross(arm) + s.angular_velocity.cross(s.angular_velocity.cross(arm));
    s.rotation = s.rotation * parent_T_child.rotation;
  }
  return child;
}

const Pose mounted{exp_so3(Vec3(0.3, -0.8, 1.1)), Vec3(0.5, -0.2, 0.9)};

TEST(RigidJoint, IsTheMountingOfOneSensorRelativeToTheOther) {
  const auto child = carried_by(freely_moving(), mounted);
  const RecordedMotion motion =
      test::recorded_motion({measured_segment("a", freely_moving()), measured_segment("b", child)});
  const JointResult found = rigid_joint(motion, 0, 1);
  EXPECT_EQ(found.joint.type, EstimatedJointType::rigid);
  EXPECT_LT((found.joint.point_in_parent - mounted.position).norm(), 1e-3);
  EXPECT_LT((found.joint.axis_in_parent - mounted.rotation.col(2)).norm(), 1e-9) << "the child's z";
  Pose pose;
  for (const DhRowEstimate& row : found.dh) {
    pose = pose * transform(row.row);
    EXPECT_TRUE(row.variable().empty());
  }
  EXPECT_LT((pose.rotation - mounted.rotation).norm(), 1e-9);
  EXPECT_LT((pose.position - mounted.position).norm(), 1e-3);
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_EQ(found.notes[0].kind, IdentificationNoteKind::no_relative_motion);
  EXPECT_EQ(found.states.size(), motion.rows());
  EXPECT_EQ(found.states[7].rotation, child[7].rotation);
  EXPECT_FALSE(found.search);
}

TEST(RigidJoint, WhatTheMotionDoesNotTellOfTheLeverIsZero) {
  const auto turning = propagate(test::at_rest(), std::vector<DhLeaf>{{.theta_signal = 0}}, three_signals());
  const RecordedMotion motion =
      test::recorded_motion({measured_segment("a", turning), measured_segment("b", carried_by(turning, mounted))});
  const Vec3 lever = rigid_joint(motion, 0, 1).joint.point_in_parent;
  EXPECT_LT((lever - Vec3(mounted.position.x(), mounted.position.y(), 0.0)).norm(), 1e-3) << "along z nothing changes";
  const RecordedMotion resting =
      test::recorded_motion({measured_segment("a", test::at_rest()), measured_segment("b", test::at_rest())});
  EXPECT_LT(rigid_joint(resting, 0, 1).joint.point_in_parent.norm(), 1e-9);
}

TEST(RigidJoint, UnusableRowsDoNotCount) {
  RecordedMotion motion = test::recorded_motion(
      {measured_segment("a", freely_moving()), measured_segment("b", carried_by(freely_moving(), mounted))});
  for (std::size_t row = 100; row < 120; ++row) {
    motion.usable[row] = false;
    motion.segments[1].acceleration[row] = Vec3(100.0, 100.0, 100.0);
  }
  EXPECT_LT((rigid_joint(motion, 0, 1).joint.point_in_parent - mounted.position).norm(), 1e-3);
}

/// A universal joint whose centre the pair's fit knows.
struct CentredPair {
  DhLeaf mount{.theta = 0.7, .d = 0.2, .alpha = -1.1, .a = 0.5}, end{.theta = -1.9, .d = 0.15, .a = 0.3};
  std::vector<DhLeaf> leaves{mount, {.alpha = 1.4, .theta_signal = 0}, {.theta_signal = 1}, end};
  RecordedMotion motion =
      test::recorded_motion({measured_segment("a", freely_moving()),
                             measured_segment("b", propagate(freely_moving(), leaves, three_signals()))});
  SegmentTree tree;
  JointTypeEvidence evidence{.type = EstimatedJointType::universal,
                             .axis_in_parent = transform(mount).rotation.col(2),
                             .axis_in_child = transform(end).rotation.transpose().col(2)};
  CentredPair() {
    tree.pairs = {{.first = 0,
                   .second = 1,
                   .point_in_first = transform(mount).position,
                   .point_in_second = transform(end).inverse().position}};
    orient_tree(tree, {{0, 1}});
  }
};

TEST(JointAboutPoint, HasTheCentreInBothSensorsAndStartsWhereTheMotionBegins) {
  CentredPair pair;
  pair.motion.first_motion_row = 40;
  const JointResult found = joint_about_point(pair.motion, pair.tree, 0, 1, pair.evidence);
  EXPECT_EQ(found.joint.point_in_parent, pair.tree.pairs[0].point_in_first);
  EXPECT_EQ(found.joint.point_in_child, pair.tree.pairs[0].point_in_second);
  EXPECT_EQ(found.notes.at(0).kind, IdentificationNoteKind::universal_joint);
  ASSERT_EQ(found.dh.size(), 4U);
  Pose pose;
  for (const DhRowEstimate& row : found.dh) pose = pose * transform(row.row);
  const Pose truth = transform(pair.leaves, std::vector{three_signals()[0].angle[40], three_signals()[1].angle[40]});
  EXPECT_LT((pose.rotation - truth.rotation).norm(), 1e-9);
  EXPECT_LT((pose.position - truth.position).norm(), 1e-9);
  EXPECT_EQ(found.joint.sd.along_axis, 1.0) << "not estimated";
}

TEST(JointAboutPoint, OfARevoluteJointIsThatWithoutANote) {
  CentredPair pair;
  pair.evidence.type = EstimatedJointType::revolute;
  const JointResult found = joint_about_point(pair.motion, pair.tree, 0, 1, pair.evidence);
  EXPECT_EQ(found.joint.type, EstimatedJointType::revolute);
  EXPECT_EQ(found.dh.size(), 3U);
  EXPECT_TRUE(found.notes.empty());
}

TEST(JointAboutPoint, OfASphericalJointHasThreeVariables) {
  CentredPair pair;
  pair.evidence.type = EstimatedJointType::spherical;
  const JointResult found = joint_about_point(pair.motion, pair.tree, 0, 1, pair.evidence);
  EXPECT_EQ(found.dh.size(), 5U);
  EXPECT_EQ(found.notes.at(0).kind, IdentificationNoteKind::spherical_joint);
}

TEST(JointAboutPoint, TheParentMayBeTheSecondSensorOfThePair) {
  CentredPair pair;
  std::swap(pair.motion.segments[0], pair.motion.segments[1]);
  std::swap(pair.tree.pairs[0].point_in_first, pair.tree.pairs[0].point_in_second);
  const JointResult found = joint_about_point(pair.motion, pair.tree, 1, 0, pair.evidence);
  EXPECT_EQ(joint_name(found.joint), "a-b");
  EXPECT_EQ(found.joint.point_in_parent, CentredPair().tree.pairs[0].point_in_first);
}

TEST(PrismaticJoint, TranslatesAlongItsAxis) {
  const RecordedMotion motion = test::recorded_motion(
      {measured_segment("a", freely_moving()), measured_segment("b", carried_by(freely_moving(), mounted))});
  const Vec3 axis = Vec3(0.6, 0.0, 0.8);
  const JointResult found = prismatic_joint(motion, 0, 1,
                                            {.type = EstimatedJointType::prismatic,
                                             .axis_in_parent = axis,
                                             .axis_in_child = mounted.rotation.transpose() * axis});
  ASSERT_EQ(found.dh.size(), 3U);
  EXPECT_EQ(found.dh[1].d_variable, "a-b");
  EXPECT_TRUE(found.dh[1].theta_variable.empty());
  Pose pose;
  for (std::size_t i = 0; i < 3; ++i) {
    DhNumbers row = found.dh[i].row;
    if (i == 1) row.d += 0.25;
    pose = pose * transform(row);
  }
  EXPECT_LT((pose.rotation - mounted.rotation).norm(), 1e-9);
  EXPECT_LT((pose.position - 0.25 * axis).norm(), 1e-9) << "its place is not known, its direction is";
  EXPECT_EQ(found.notes.at(0).kind, IdentificationNoteKind::prismatic_joint);
}

/// Three segments in series with known joints, ordered.
struct SerialMachine {
  OrderedMotion ordered;
  std::vector<JointTypeEvidence> types = std::vector<JointTypeEvidence>(2);

  SerialMachine() {
    ordered.motion = test::serial_machine(freely_moving(), 3, test::general_hinge());
    const auto tree = segment_tree(ordered.motion, "a");
    EXPECT_TRUE(tree);
    ordered.tree = *tree;
  }
  Result<std::vector<JointResult>> searched(const LinkSearchOptions& options) const {
    return search_links(ordered, types, options, Rng(1), {});
  }
};

TEST(SearchLinks, FindsTheJointsFromTheRootOutwards) {
  const SerialMachine machine;
  const auto joints = machine.searched({.engine = Enumeration{.rows = 150}});
  ASSERT_TRUE(joints) << joints.error().what;
  ASSERT_EQ(joints->size(), 2U);
  const JointGeometry truth =
      fit_revolute_geometry(test::general_hinge(), {{{-0.6}, {0}, {0}}, {{0.1}, {0}, {0}}, {{0.9}, {0}, {0}}});
  EXPECT_EQ(joint_name((*joints)[0].joint), "a-b");
  EXPECT_EQ(joint_name((*joints)[1].joint), "b-c");
  for (const JointResult& found : *joints) {
    EXPECT_LT(found.joint.axis_in_parent.cross(truth.axis_in_parent).norm(), 0.01);
    EXPECT_LT((found.joint.point_in_child - truth.point_in_child).cross(truth.axis_in_child).norm(), 0.03);
    ASSERT_TRUE(found.search);
    EXPECT_EQ(found.search->rows, 150);
    EXPECT_GT(found.search->holdout.total, 0.0) << "evaluated on rows that were not fitted";
    EXPECT_LT(found.search->holdout.total, 2.0 * found.search->fitted.total + 1e-3);
    EXPECT_LE(found.search->merged.size(), found.search->found.size());
  }
}

TEST(SearchLinks, AsManyLinksAsAskedFor) {
  const SerialMachine machine;
  EXPECT_EQ(machine.searched({.engine = Enumeration{.rows = 60}, .links = 1})->size(), 1U);
  EXPECT_EQ(machine.searched({.engine = Enumeration{.rows = 60}, .links = 9})->size(), 2U);
}

TEST(SearchLinks, EveryTypeOfJointIsEstimatedInItsOwnWay) {
  SerialMachine machine;
  machine.types[0].type = EstimatedJointType::spherical;
  machine.types[1].type = EstimatedJointType::prismatic;
  const auto joints = machine.searched({.engine = Enumeration{.rows = 60}});
  ASSERT_TRUE(joints);
  EXPECT_EQ((*joints)[0].joint.type, EstimatedJointType::spherical);
  EXPECT_EQ((*joints)[1].joint.type, EstimatedJointType::prismatic);
  EXPECT_FALSE((*joints)[0].search || (*joints)[1].search);
}

TEST(SearchLinks, SensorsOfOneBodyShareRigidJoints) {
  SerialMachine machine;
  for (JointTypeEvidence& evidence : machine.types) evidence.type = EstimatedJointType::rigid;
  const auto joints = machine.searched({});
  ASSERT_TRUE(joints);
  for (const JointResult& joint : *joints) EXPECT_EQ(joint.joint.type, EstimatedJointType::rigid);
}

TEST(SearchLinks, AJointThatTurnsTooLittleForASearchKeepsItsType) {
  SerialMachine machine;
  const auto parent = freely_moving();
  const auto child = propagate(parent, test::general_hinge(), std::vector{test::wave(0.015, 0.9, 1.0)});
  machine.ordered.motion = test::recorded_motion({measured_segment("a", parent), measured_segment("b", child)});
  const auto tree = segment_tree(machine.ordered.motion, "a");
  ASSERT_TRUE(tree);
  machine.ordered.tree = *tree;
  const auto joints = machine.searched({.engine = Enumeration{.rows = 60}});
  ASSERT_TRUE(joints) << joints.error().what;
  EXPECT_EQ((*joints)[0].joint.type, EstimatedJointType::revolute);
  EXPECT_FALSE((*joints)[0].search);
}

TEST(SearchLinks, AJointWithTooFewRowsForASearchIsThatOfItsPair) {
  SerialMachine machine;
  for (std::size_t row = 60; row < machine.ordered.motion.rows(); ++row) machine.ordered.motion.usable[row] = false;
  const auto joints = machine.searched({});
  ASSERT_TRUE(joints) << joints.error().what;
  EXPECT_EQ((*joints)[0].joint.type, EstimatedJointType::revolute);
  EXPECT_FALSE((*joints)[0].search);
}

TEST(SearchLinks, GivesTheSameBitsForAnyNumberOfThreads) {
  const SerialMachine machine;
  const auto one = machine.searched({.engine = MemeticProgramming{.rows = 80}, .threads = 1});
  for (const int threads : {2, 7}) {
    const auto many = machine.searched({.engine = MemeticProgramming{.rows = 80}, .threads = threads});
    ASSERT_TRUE(one && many);
    for (std::size_t i = 0; i < one->size(); ++i)
      EXPECT_EQ((*one)[i].joint.point_in_child, (*many)[i].joint.point_in_child);
  }
}

}  // namespace
}  // namespace kinfer
