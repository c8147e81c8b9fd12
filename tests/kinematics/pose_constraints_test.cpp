// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/poses/pose_constraints.hpp"

#include <gtest/gtest.h>

#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/same_joints.hpp"
#include "support/robots.hpp"

namespace kinfer {
namespace {

TEST(JointRange, IsThatOfTheLimitsOrTheUsualOneLessAHundredthAtEachEnd) {
  Joint joint;
  EXPECT_NEAR(joint_range(joint).low, -0.98 * 170.0 * degree, 1e-12);
  EXPECT_NEAR(joint_range(joint).high, 0.98 * 170.0 * degree, 1e-12);
  joint.type = JointType::prismatic;
  EXPECT_NEAR(joint_range(joint).low, 0.003, 1e-12);
  EXPECT_NEAR(joint_range(joint).high, 0.297, 1e-12);
  joint.lower = 1.0, joint.upper = 2.0;
  EXPECT_NEAR(joint_range(joint).low, 1.01, 1e-12);
  EXPECT_NEAR(joint_range(joint).high, 1.99, 1e-12);
}

TEST(PoseConstraints, FloorAndClearanceAreMeasuredFromTheBase) {
  Chain chain = test::nominal_robot();
  const VectorXd q = VectorXd::Zero(6);
  const Vec3 tool = forward(chain, q).position;
  const double radius = tool.head<2>().norm();
  const auto is_allowed = [&](const PoseConstraints& space) { return satisfies_constraints(chain, q, space); };
  EXPECT_TRUE(is_allowed({}));
  for (const Frame& base : {Frame{}, Frame{.xyz = Vec3(5.0, -3.0, 2.0), .rotation = exp_so3(Vec3(0.4, -0.2, 1.0))}}) {
    chain.base = base;
    EXPECT_TRUE(is_allowed({.clearance = radius - 1e-6}));
    EXPECT_FALSE(is_allowed({.clearance = radius + 1e-6}));
    EXPECT_TRUE(is_allowed({.lowest = -1.0}));
    EXPECT_FALSE(is_allowed({.lowest = tool.z() + 1e-6}));
  }
}

TEST(PoseConstraints, AJointBelowTheFloorIsRefusedEvenWithTheToolAbove) {
  const Chain chain = test::nominal_robot();
  EXPECT_FALSE(satisfies_constraints(chain, VectorXd::Zero(6), {.lowest = 0.6})) << "the first joint is at 0.504 m";
}

TEST(PoseConstraints, TheTargetIsSeenWithinItsAcceptanceAngle) {
  const Chain chain = test::nominal_robot();
  const VectorXd q = VectorXd::Constant(6, 0.2);
  const Pose tool = forward(chain, q);
  for (const double angle : {0.0, 0.5, 1.0, 1.5}) {
    const Vec3 direction = tool.rotation * (rot_x(angle) * Vec3::UnitZ());
    const PoseConstraints space{.instrument = tool.position + 3.0 * direction, .acceptance_angle = 0.75};
    EXPECT_EQ(satisfies_constraints(chain, q, space), angle < 0.75) << angle;
  }
}

TEST(DrawPoseNear, StaysWithinTheRangesAndTheSpace) {
  const Chain chain = test::nominal_robot();
  const PoseConstraints space{.lowest = 0.2, .clearance = 0.3};
  const auto start = draw_poses(chain, space, 1, Rng(1));
  ASSERT_TRUE(start);
  Rng rng(2);
  int moved = 0;
  for (int k = 0; k < 200; ++k) {
    const VectorXd pose = draw_pose_near(chain, space, start->col(0), rng);
    if (pose.size() == 0) continue;
    ++moved;
    EXPECT_TRUE(satisfies_constraints(chain, pose, space));
    for (Eigen::Index j = 0; j < 6; ++j) {
      const JointRange range = joint_range(chain.joints[static_cast<std::size_t>(j)]);
      EXPECT_GE(pose[j], range.low);
      EXPECT_LE(pose[j], range.high);
    }
  }
  EXPECT_GT(moved, 100);
  EXPECT_EQ(draw_pose_near(chain, {.lowest = 50.0}, start->col(0), rng).size(), 0) << "there is no such pose";
}

TEST(SameJoints, CountTypesAndConventionsMatterButNumbersDoNot) {
  const Chain chain = test::er20();
  EXPECT_TRUE(have_same_joints(chain, test::with_table3_errors(chain)));
  Chain other = chain;
  other.joints.pop_back();
  EXPECT_FALSE(have_same_joints(chain, other));
  other = chain;
  other.joints[2].type = JointType::prismatic;
  EXPECT_FALSE(have_same_joints(chain, other));
  other = chain;
  other.joints[3].link = DhLink{};
  EXPECT_FALSE(have_same_joints(chain, other));
  EXPECT_TRUE(have_same_joints({}, {}));
}

}  // namespace
}  // namespace kinfer
