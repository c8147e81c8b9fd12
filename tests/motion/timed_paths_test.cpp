// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/timed_paths.hpp"

#include <gtest/gtest.h>

#include "laws/example_chains.hpp"

namespace kinfer::motion {
namespace {

const std::vector<MotionLimits> limits(6, {1.5, 6.0, 60.0});

Chain limited(double limit = 2.9) {
  Chain chain = laws::er20();
  for (Joint& joint : chain.joints) joint.lower = -limit, joint.upper = limit;
  return chain;
}

VectorXd posture() {
  return (VectorXd(6) << 0.2, -0.5, 0.6, 0.3, 0.9, -0.1).finished();
}

/// From the tool at posture() along `way`, turning by `turn`.
std::vector<ReachTarget> line_of(const Chain& chain, const Vec3& way, const Vec3& turn) {
  const Pose tool = forward(chain, posture());
  return {{tool.position, FullGoal{tool.rotation}}, {tool.position + way, FullGoal{exp_so3(turn) * tool.rotation}}};
}

TEST(ToolSpacePath, IsAStraightLineOfTheToolWithinTheLimitsOfTheJoints) {
  const Chain chain = limited();
  const Vec3 way(0.10, -0.15, 0.08);
  const auto targets = line_of(chain, way, Vec3(0.2, 0.1, -0.1));
  const PathResult result = tool_space_path(chain, targets, posture(), limits, {}, 0.004).value();
  ASSERT_FALSE(result.obstacle);
  const TimedPath& path = result.path;
  EXPECT_EQ(path.time.back(), path.duration);
  double along = 0.0;
  for (Eigen::Index i = 0; i < path.position.cols(); ++i) {
    const Vec3 from_start = forward(chain, path.position.col(i)).position - targets[0].position;
    EXPECT_LT((from_start - from_start.dot(way.normalized()) * way.normalized()).norm(), 1e-8);
    EXPECT_GE(from_start.dot(way.normalized()), along - 1e-8);
    along = from_start.dot(way.normalized());
    for (Eigen::Index k = 0; k < 6; ++k) {
      EXPECT_LE(std::abs(path.velocity(k, i)), limits[0].velocity);
      EXPECT_LE(std::abs(path.acceleration(k, i)), limits[0].acceleration);
    }
  }
  EXPECT_NEAR(along, way.norm(), 1e-8);
}

TEST(ToolSpacePath, IsSlowedDownWhereTheJointsAreSlow) {
  const Chain chain = limited();
  const auto targets = line_of(chain, Vec3(0.1, 0.1, 0.0), Vec3::Zero());
  const PathResult quick = tool_space_path(chain, targets, posture(), limits, {}, 0.004).value();
  const std::vector<MotionLimits> slow(6, {0.02, 6.0, 60.0});
  const PathResult slowed = tool_space_path(chain, targets, posture(), slow, {}, 0.004).value();
  EXPECT_GT(slowed.path.slowed_by, 1.5);
  EXPECT_GT(slowed.path.duration, 1.5 * quick.path.duration);
  EXPECT_LE(slowed.path.velocity.cwiseAbs().maxCoeff(), 0.02);
}

TEST(ToolSpacePath, WhatCannotBeDrivenIsNamed) {
  const Chain chain = limited();
  const PathResult far =
      tool_space_path(chain, line_of(chain, Vec3(9.0, 0.0, 0.0), Vec3::Zero()), posture(), limits, {}, 0.02).value();
  ASSERT_TRUE(far.obstacle);
  EXPECT_NE(far.obstacle->kind, PathObstacle::Kind::outside_limits);
  const Vec3 start = forward(chain, posture()).position;
  const Eigen::Index end = far.path.position.cols() - 1;
  ASSERT_GT(end, 0);
  EXPECT_LT(forward(chain, far.path.position.col(end)).position.x() - start.x(), 3.0)
      << "of 9 m only what can be reached is written";
  for (Eigen::Index i = 0; i <= end; ++i)
    EXPECT_LT((forward(chain, far.path.position.col(i)).position - start).tail<2>().norm(), 1e-6) << "on the line";
  EXPECT_EQ(far.path.position.cols(), std::ssize(far.path.time));

  std::vector<ReachTarget> beyond = line_of(chain, Vec3(0.1, 0.0, 0.0), Vec3::Zero());
  for (ReachTarget& target : beyond) target.position.x() += 9.0;
  const PathResult nowhere = tool_space_path(chain, beyond, posture(), limits, {}, 0.02).value();
  ASSERT_TRUE(nowhere.obstacle);
  EXPECT_EQ(nowhere.path.position.cols(), 0);
  EXPECT_TRUE(nowhere.path.time.empty());

  // A straightened wrist is singular.
  VectorXd straight = posture();
  straight[4] = 0.0;
  const Pose tool = forward(chain, straight);
  const std::vector<ReachTarget> through{{tool.position, FullGoal{tool.rotation}},
                                         {tool.position + Vec3(0, 0, 0.01), FullGoal{tool.rotation}}};
  const PathResult singular = tool_space_path(chain, through, straight, limits, {}, 0.02).value();
  ASSERT_TRUE(singular.obstacle);
  EXPECT_EQ(singular.obstacle->kind, PathObstacle::Kind::near_singular);
}

TEST(JointSpacePath, LimitsOfPositionAreChecked) {
  const Chain chain = limited(1.0);
  MatrixXd waypoints = MatrixXd::Zero(6, 3);
  waypoints(2, 1) = 1.4;
  const PathResult result = joint_space_path(chain, waypoints, limits, {}, 0.01).value();
  ASSERT_TRUE(result.obstacle);
  EXPECT_EQ(result.obstacle->kind, PathObstacle::Kind::outside_limits);
  EXPECT_EQ(result.obstacle->joint, 2);
  EXPECT_EQ(result.obstacle->line, 0);
  waypoints(2, 1) = 0.9;
  EXPECT_FALSE(joint_space_path(chain, waypoints, limits, {}, 0.01)->obstacle);
}

TEST(JointSpacePath, TooManySamplesAreRefusedBeforeTheWork) {
  const Chain chain = limited();
  MatrixXd waypoints = MatrixXd::Zero(6, 3);
  waypoints(2, 1) = 0.9;
  for (const MotionLimits& slow : {MotionLimits{1e-9, 6.0, 60.0}, MotionLimits{1.5, 1e-12, 60.0},
                                   MotionLimits{1.5, 6.0, 1e-20}, MotionLimits{1e-300, 1e-300, 1e-300}}) {
    const auto refused = joint_space_path(chain, waypoints, std::vector<MotionLimits>(6, slow), {}, 0.004);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().what.find("rows, one every 4 ms, and at most 2000000 are written"), std::string::npos)
        << refused.error().what;
  }
  // 1800 s at constant velocity, and as much as the ramps take: 1.8 million rows are written, 2.2 million are not.
  waypoints.col(2) = waypoints.col(1);
  const std::vector<MotionLimits> slow(6, {0.0005, 6.0, 60.0});
  const auto largest = joint_space_path(chain, waypoints, slow, {}, 0.001);
  ASSERT_TRUE(largest) << largest.error().what;
  EXPECT_EQ(std::ssize(largest->path.time), static_cast<std::ptrdiff_t>(largest->path.duration / 0.001) + 2);
  EXPECT_FALSE(joint_space_path(chain, waypoints, slow, {}, 0.0008));
}

TEST(ToolSpacePath, TooManySamplesAreRefusedBeforeTheWork) {
  const Chain chain = limited();
  const auto targets = line_of(chain, Vec3(0.1, 0.1, 0.0), Vec3::Zero());
  ToolPathOptions crawling;
  crawling.translation = {1e-6, 4e-6, 2e-5}, crawling.rotation = {4e-6, 1.6e-5, 8e-5};
  const auto refused = tool_space_path(chain, targets, posture(), limits, crawling, 0.004);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("at most 500000 are written"), std::string::npos) << refused.error().what;
  const auto held_up =
      tool_space_path(chain, targets, posture(), std::vector<MotionLimits>(6, {1e-9, 6.0, 60.0}), {}, 0.004);
  EXPECT_FALSE(held_up) << "the joints make it slow";
}

TEST(Interpolate, TurnsEachKindOfOrientationEvenly) {
  const ReachTarget axis =
      interpolate({Vec3::Zero(), AxisGoal{Vec3::UnitX()}}, {Vec3::Ones(), AxisGoal{Vec3::UnitY()}}, 0.5);
  EXPECT_LT((std::get<AxisGoal>(axis.orientation).direction - Vec3(1, 1, 0).normalized()).norm(), 1e-15);
  EXPECT_EQ(axis.position, 0.5 * Vec3::Ones());
  const ReachTarget pitch = interpolate({Vec3::Zero(), PitchGoal{0.2}}, {Vec3::Zero(), PitchGoal{0.6}}, 0.25);
  EXPECT_DOUBLE_EQ(std::get<PitchGoal>(pitch.orientation).angle, 0.3);
  const Vec3 turn(0.3, -0.2, 0.1);
  const ReachTarget full = interpolate({Vec3::Zero(), FullGoal{}}, {Vec3::Zero(), FullGoal{exp_so3(turn)}}, 0.5);
  EXPECT_LT((std::get<FullGoal>(full.orientation).rotation - exp_so3(0.5 * turn)).norm(), 1e-14);
}

}  // namespace
}  // namespace kinfer::motion
