// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/geometry/initial_joint.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "identify/measured_segments.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;
using test::freely_moving;
using test::measured_segment;
using test::wave;

/// Two segments whose joint is known, and the pair's fit with the true points.
struct KnownJoint {
  RecordedMotion motion;
  SegmentTree tree;

  KnownJoint(const std::vector<FrameState>& parent, const std::vector<FrameState>& child, const Vec3& in_parent,
             const Vec3& in_child) {
    motion = test::recorded_motion({measured_segment("parent", parent), measured_segment("child", child)});
    tree.pairs = {{.first = 0, .second = 1, .point_in_first = in_parent, .point_in_second = in_child}};
    orient_tree(tree, {{0, 1}});
  }
  InitialJoint estimate(EstimatedJointType type) const { return estimate_initial_joint(motion, tree, 0, 1, type); }
  Mat3 rotation(std::size_t row) const {
    return motion.segments[0].rotation[row].transpose() * motion.segments[1].rotation[row];
  }
};

const DhLeaf joint_mount{.theta = 0.7, .d = 0.2, .alpha = -1.1, .a = 0.5},
    joint_end{.theta = -1.9, .d = 0.15, .a = 0.3};

KnownJoint known_joint(const std::vector<DhLeaf>& turns, const std::vector<JointSignal>& signals) {
  std::vector<DhLeaf> leaves{joint_mount};
  leaves.insert(leaves.end(), turns.begin(), turns.end());
  leaves.push_back(joint_end);
  return {freely_moving(), propagate(freely_moving(), leaves, signals), transform(joint_mount).position,
          transform(joint_end).inverse().position};
}

/// parent_T_child of the initial estimate at a row.
Pose estimated_pose(const InitialJoint& joint, std::size_t row) {
  Pose parent_T_here;
  std::size_t k = 0;
  for (const InsBody& body : joint.bodies) {
    Mat3 turn = Mat3::Identity();
    Vec3 slid = Vec3::Zero();
    const auto position = [&](std::size_t i) { return joint.joint_positions[k + i][row]; };
    if (body.motion == JointMotion::revolute) turn = rot_z(position(0));
    if (body.motion == JointMotion::prismatic) slid = position(0) * body.parent_R_axis.col(2);
    if (body.motion == JointMotion::spherical) turn = exp_so3({position(0), position(1), position(2)});
    k += static_cast<std::size_t>(degrees_of_freedom(body.motion));
    const Mat3 rotation = body.parent_R_axis * turn * body.child_R_axis.transpose();
    parent_T_here = parent_T_here * Pose{rotation, body.point_in_parent + slid - rotation * body.point_in_child};
  }
  return parent_T_here;
}

void expect_true_motion(const KnownJoint& truth, const InitialJoint& joint, double tolerance) {
  for (const std::size_t row : {0U, 77U, 250U, 599U}) {
    const Pose pose = estimated_pose(joint, row);
    EXPECT_LT((pose.rotation - truth.rotation(row)).norm(), tolerance) << name(joint.type) << " " << row;
    const PairFit& pair = truth.tree.pairs[0];
    EXPECT_LT((pose * pair.point_in_second - pair.point_in_first).norm(), tolerance) << "the centre stays where it is";
  }
}

void expect_continuous(const InitialJoint& joint) {
  for (const std::vector<double>& positions : joint.joint_positions)
    for (std::size_t row = 1; row < positions.size(); ++row)
      ASSERT_LT(std::abs(positions[row] - positions[row - 1]), 0.3) << name(joint.type) << " " << row;
}

TEST(InitialJoint, OfARevoluteJointIsExactAndUnwrapped) {
  const JointSignal turns = wave(7.0, 0.1, 0.3);  // more than a revolution
  const KnownJoint truth = known_joint({{.theta_signal = 0}}, {turns});
  const InitialJoint joint = truth.estimate(EstimatedJointType::revolute);
  ASSERT_EQ(joint.bodies.size(), 1U);
  expect_true_motion(truth, joint, 1e-6);
  expect_continuous(joint);
  const Vec3 axis = joint.bodies[0].parent_R_axis.col(2), true_axis = transform(joint_mount).rotation.col(2);
  EXPECT_LT(axis.cross(true_axis).norm(), 1e-6);
  const double sense = axis.dot(true_axis), moved = joint.joint_positions[0][250] - joint.joint_positions[0][0];
  EXPECT_NEAR(sense * moved, turns.angle[250] - turns.angle[0], 1e-6);
}

TEST(InitialJoint, OfAUniversalJointHasBothAxesAndOneFreeAngleBetweenThem) {
  for (const double between : {1.4, 0.5}) {
    const KnownJoint truth = known_joint({{.alpha = between, .theta_signal = 0}, {.theta_signal = 1}},
                                         {wave(0.6, 0.9, 1.0), wave(0.4, 1.3, 0.2)});
    const InitialJoint joint = truth.estimate(EstimatedJointType::universal);
    ASSERT_EQ(joint.bodies.size(), 2U);
    expect_true_motion(truth, joint, 1e-4);
    expect_continuous(joint);
    EXPECT_LT(joint.bodies[0].parent_R_axis.col(2).cross(transform(joint_mount).rotation.col(2)).norm(), 1e-4);
    const Vec3 in_child = transform(joint_end).rotation.transpose().col(2);
    EXPECT_LT(joint.bodies[1].child_R_axis.col(2).cross(in_child).norm(), 1e-4);
    EXPECT_EQ(joint.bodies[1].free_parent_rotation, (std::array{false, true, false}));
  }
}

/// Turns by `most` [rad] and back within two seconds; the rates are of no interest here.
JointSignal one_swing(double most) {
  JointSignal signal = wave(0.0, 1.0, 0.0);
  for (std::size_t row = 0; row < 600; ++row)
    signal.angle[row] = most * std::exp(-std::pow(0.01 * static_cast<double>(row) - 3.0, 2));
  return signal;
}

TEST(InitialJoint, OfASphericalJointIsContinuousBeyondHalfARevolution) {
  const KnownJoint truth =
      known_joint({{.alpha = 1.4, .theta_signal = 0}, {.alpha = -1.3, .theta_signal = 1}, {.theta_signal = 2}},
                  {one_swing(4.5), wave(0.3, 0.4, 0.2), wave(0.2, 0.3, 2.0)});
  const InitialJoint joint = truth.estimate(EstimatedJointType::spherical);
  expect_true_motion(truth, joint, 1e-6);
  expect_continuous(joint);
  double farthest = 0.0;
  for (std::size_t row = 0; row < 600; ++row)
    farthest = std::max(
        farthest,
        Vec3(joint.joint_positions[0][row], joint.joint_positions[1][row], joint.joint_positions[2][row]).norm());
  EXPECT_GT(farthest, 3.2) << "the case is met";
}

TEST(InitialJoint, OfARigidPairIsItsMeanPose) {
  const KnownJoint truth = known_joint({}, {});
  const InitialJoint joint = truth.estimate(EstimatedJointType::rigid);
  ASSERT_EQ(joint.bodies.size(), 1U);
  EXPECT_TRUE(joint.joint_positions.empty());
  expect_true_motion(truth, joint, 1e-9);
}

TEST(InitialJoint, OfAPrismaticJointFollowsTheMotionAlongItsAxis) {
  const JointSignal slide = wave(0.3, 0.5, 0.0);
  const Mat3 home = exp_so3(Vec3(0.4, -0.7, 0.2));
  const Vec3 axis = Vec3(0.2, 0.9, -0.4).normalized();
  std::vector<FrameState> child(600);
  for (std::size_t row = 0; row < 600; ++row) {
    child[row].rotation = home;
    child[row].acceleration = slide.angular_acceleration[row] * axis;
  }
  const KnownJoint truth(test::at_rest(), child, Vec3(0.1, 0.2, 0.3), Vec3::Zero());
  const InitialJoint joint = truth.estimate(EstimatedJointType::prismatic);
  ASSERT_EQ(joint.joint_positions.size(), 1U);
  EXPECT_LT(joint.bodies[0].parent_R_axis.col(2).cross(axis).norm(), 1e-6);
  EXPECT_LT((joint.bodies[0].parent_R_axis * joint.bodies[0].child_R_axis.transpose() - home).norm(), 1e-9);
  // Slow displacements are left to the fit, so only the shape counts.
  const double sense = joint.bodies[0].parent_R_axis.col(2).dot(axis);
  double both = 0.0, found = 0.0, expected = 0.0, mean = 0.0;
  for (std::size_t row = 300; row < 600; ++row) mean += joint.joint_positions[0][row] / 300.0;
  for (std::size_t row = 300; row < 600; ++row) {
    const double x = joint.joint_positions[0][row] - mean, y = slide.angle[row];
    both += x * y, found += x * x, expected += y * y;
  }
  EXPECT_GT(sense * both / std::sqrt(found * expected), 0.9);
  EXPECT_NEAR(std::sqrt(found / expected), 1.0, 0.3);
}

TEST(InitialJoint, TheParentMayBeTheSecondSensorOfThePair) {
  const KnownJoint forward = known_joint({{.theta_signal = 0}}, {wave(0.6, 0.9, 1.0)});
  RecordedMotion motion = forward.motion;
  std::swap(motion.segments[0], motion.segments[1]);
  SegmentTree tree;
  tree.root = 1;
  tree.pairs = {{.first = 0,
                 .second = 1,
                 .point_in_first = forward.tree.pairs[0].point_in_second,
                 .point_in_second = forward.tree.pairs[0].point_in_first}};
  orient_tree(tree, {{0, 1}});
  const InitialJoint joint = estimate_initial_joint(motion, tree, 1, 0, EstimatedJointType::revolute),
                     same = forward.estimate(EstimatedJointType::revolute);
  EXPECT_EQ(joint.bodies[0].point_in_parent, same.bodies[0].point_in_parent);
  EXPECT_EQ(joint.bodies[0].point_in_child, same.bodies[0].point_in_child);
  EXPECT_EQ(joint.joint_positions, same.joint_positions);
  EXPECT_EQ(joint.bodies[0].sensor, 0);
}

TEST(InitialJoint, UnusableRowsDoNotCount) {
  const KnownJoint clean = known_joint({{.theta_signal = 0}}, {wave(0.6, 0.9, 1.0)});
  KnownJoint faulty = clean;
  for (std::size_t row = 200; row < 230; ++row) {
    faulty.motion.usable[row] = false;
    faulty.motion.segments[1].angular_velocity[row] = Vec3(50.0, 20.0, -30.0);
  }
  const Vec3 axis = faulty.estimate(EstimatedJointType::revolute).bodies[0].parent_R_axis.col(2);
  EXPECT_LT(axis.cross(clean.estimate(EstimatedJointType::revolute).bodies[0].parent_R_axis.col(2)).norm(), 1e-6);
}

}  // namespace
}  // namespace kinfer
