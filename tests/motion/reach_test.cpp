// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/reach.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "laws/example_chains.hpp"

namespace kinfer::motion {
namespace {

Chain with_limits(Chain chain, double revolute = 2.8, double prismatic = 0.5) {
  for (Joint& joint : chain.joints) {
    const double limit = rotates(joint.type) ? revolute : prismatic;
    joint.lower = -limit, joint.upper = limit;
  }
  return chain;
}

VectorXd random_posture(const Chain& chain, Rng rng) {
  VectorXd q(dof(chain));
  const std::vector<int> joints = active_joints(chain);
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    const Joint& joint = chain.joints[static_cast<std::size_t>(joints[static_cast<std::size_t>(k)])];
    q[k] = rng.uniform(joint.lower, joint.upper);
  }
  return q;
}

ReachTarget full_target(const Pose& tool) {
  return {tool.position, FullGoal{tool.rotation}};
}

void expect_inside(const Chain& chain, const VectorXd& q) {
  const std::vector<int> joints = active_joints(chain);
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    const Joint& joint = chain.joints[static_cast<std::size_t>(joints[static_cast<std::size_t>(k)])];
    EXPECT_GE(q[k], joint.lower);
    EXPECT_LE(q[k], joint.upper);
  }
}

class ReachLaws : public ::testing::TestWithParam<Chain> {};

TEST_P(ReachLaws, EveryPoseInsideTheLimitsIsReached) {
  const Chain chain = with_limits(GetParam());
  const ReachSolver solver(chain, {});
  for (std::uint64_t k = 0; k < 40; ++k) {
    const Pose tool = forward(chain, random_posture(chain, Rng(5).stream(k)));
    const ReachSolution solution = solver.solve(full_target(tool), random_posture(chain, Rng(6).stream(k)));
    ASSERT_EQ(solution.status, ReachStatus::reached) << k;
    const VectorXd& q = solution.postures.front().q;
    expect_inside(chain, q);
    const Pose there = forward(chain, q);
    EXPECT_LT((there.position - tool.position).norm(), 1.01e-9);
    EXPECT_LT(angle_between(there.rotation, tool.rotation), 2e-8);  // acos of a rounded cosine
    EXPECT_NEAR(solution.position_error, (there.position - tool.position).norm(), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(all, ReachLaws, ::testing::ValuesIn(laws::examples_with_joints()),
                         [](const auto& test) { return laws::test_name(test.param); });

/// Three joints that slide along x, y and z, and a wrist with a tool of the length `tool`, 0: none.
Chain gantry(double lower, double upper, double tool) {
  Chain chain;
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())})
    chain.joints.push_back({.name = "s" + std::to_string(chain.joints.size()),
                            .parent = static_cast<int>(chain.joints.size()) - 1,
                            .type = JointType::prismatic,
                            .link = UrdfLink{.axis = axis},
                            .lower = lower,
                            .upper = upper});
  if (tool > 0.0)
    for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())})
      chain.joints.push_back({.name = "r" + std::to_string(chain.joints.size()),
                              .parent = static_cast<int>(chain.joints.size()) - 1,
                              .link = UrdfLink{.axis = axis}});
  chain.tool.xyz = Vec3(0.0, 0.3 * tool, tool);
  return chain;
}

TEST(Reach, NoTravelOfJointsThatSlideIsTooLongOrTooShort) {
  const double no_limit = std::numeric_limits<double>::infinity();
  for (const double size : {2e-4, 1.0, 700.0, 1e4})
    for (const bool is_limited : {true, false}) {
      const Chain chain = gantry(is_limited ? 0.0 : -no_limit, is_limited ? size : no_limit, 0.0);
      const ReachSolver solver(chain, {.position_tolerance = 1e-9 * size});
      for (std::uint64_t k = 0; k < 20; ++k) {
        Rng rng = Rng(5).stream(k);
        const Vec3 part{rng.uniform(), rng.uniform(), rng.uniform()};
        const ReachSolution solution = solver.solve({size * part}, middle_posture(chain));
        EXPECT_EQ(solution.status, ReachStatus::reached) << size << " m, target " << k;
      }
    }
}

TEST(Reach, AWristOnALongGantryIsTurnedAndCarriedToItsTarget) {
  for (const double size : {1.0, 100.0, 2000.0}) {
    const Chain chain = gantry(0.0, size, 0.2);
    const ReachSolver solver(chain, {.position_tolerance = 1e-9 * size});
    for (std::uint64_t k = 0; k < 20; ++k) {
      Rng rng = Rng(6).stream(k);
      VectorXd q(6);
      for (double& value : q) value = rng.uniform(-1.2, 1.2);
      for (int k3 = 0; k3 < 3; ++k3) q[k3] = size * rng.uniform(0.3, 0.7);
      const ReachSolution solution = solver.solve(full_target(forward(chain, q)), middle_posture(chain));
      EXPECT_EQ(solution.status, ReachStatus::reached) << size << " m, target " << k;
    }
  }
}

TEST(Reach, APartOfTheOrientationIsMet) {
  const Chain chain = with_limits(laws::er20());
  const Vec3 tool_axis = Vec3(0.0, 0.6, 0.8);
  const ReachSolver solver(chain, {.tool_axis = tool_axis});
  for (std::uint64_t k = 0; k < 40; ++k) {
    const Pose tool = forward(chain, random_posture(chain, Rng(7).stream(k)));
    const Vec3 axis = tool.rotation * tool_axis;
    const VectorXd preferred = random_posture(chain, Rng(8).stream(k));

    const ReachSolution directed = solver.solve({tool.position, AxisGoal{axis}}, preferred);
    ASSERT_EQ(directed.status, ReachStatus::reached);
    EXPECT_LT((forward(chain, directed.postures.front().q).rotation * tool_axis - axis).norm(), 1.01e-9);

    const ReachSolution pitched = solver.solve({tool.position, PitchGoal{std::asin(axis.z())}}, preferred);
    ASSERT_EQ(pitched.status, ReachStatus::reached);
    EXPECT_NEAR((forward(chain, pitched.postures.front().q).rotation * tool_axis).z(), axis.z(), 1.01e-9);

    const ReachSolution placed = solver.solve({tool.position}, preferred);
    ASSERT_EQ(placed.status, ReachStatus::reached);
    EXPECT_LT((forward(chain, placed.postures.front().q).position - tool.position).norm(), 1.01e-9);
  }
}

/// Lengths to 0.6 m, a fifth of the joints but the first sliding, limits of 1.6 to 5.2 rad or 0.8 m about any centre.
Chain random_arm(Rng& rng, int joints) {
  Chain chain = laws::serial("any", {});
  for (int j = 0; j < joints; ++j) {
    DhLink row{};
    row.a = rng.uniform(0.0, 0.6), row.d = rng.uniform(-0.3, 0.5), row.theta = rng.uniform(-3.0, 3.0);
    const double turn = rng.uniform(-1.5, 1.5);
    row.alpha = std::array{0.0, 90.0 * degree, -90.0 * degree, turn}[rng.index(4)];
    Joint joint{.name = fmt::format("J{}", j + 1), .parent = j - 1, .link = row};
    const double half = rng.uniform(0.8, 2.6), centre = rng.uniform(-0.5, 0.5);
    joint.lower = centre - half, joint.upper = centre + half;
    if (rng.uniform() < 0.2 && j > 0) joint.type = JointType::prismatic, joint.lower = -0.2, joint.upper = 0.6;
    chain.joints.push_back(joint);
  }
  return chain;
}

/// To six decimals, as in a file.
double rounded(double x) {
  return std::round(x * 1e6) * 1e-6;
}

TEST(Reach, RoundedTargetsOfArmsWithTwoToSevenJointsAreReached) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Rng rng = Rng(13).stream(seed);
    const Chain chain = random_arm(rng, 2 + static_cast<int>(rng.index(6)));
    const ReachSolver solver(chain, {.choice = seed % 2 == 0 ? PostureChoice::first : PostureChoice::nearest});
    for (std::uint64_t k = 0; k < 8; ++k) {
      const Pose tool = forward(chain, random_posture(chain, rng.stream(k)));
      Quat turn(tool.rotation);
      turn = Quat(rounded(turn.w()), rounded(turn.x()), rounded(turn.y()), rounded(turn.z())).normalized();
      const Vec3 axis = tool.rotation.col(2).unaryExpr(&rounded).normalized();
      ReachTarget target{tool.position.unaryExpr(&rounded)};
      if (seed % 4 == 1) target.orientation = AxisGoal{axis};
      if (seed % 4 == 2) target.orientation = PitchGoal{std::asin(axis.z())};
      if (seed % 4 == 3) target.orientation = FullGoal{turn.toRotationMatrix()};
      const ReachSolution solution = solver.solve(target, middle_posture(chain));
      ASSERT_EQ(solution.status, ReachStatus::reached) << seed << ", " << k;
      expect_inside(chain, solution.postures.front().q);
      EXPECT_LT(solution.position_error, 2e-6);
      EXPECT_LT(solution.angle_error, 2e-6);
    }
  }
}

TEST(Reach, AllPosturesOfAnArmWithAWristAreFoundOnceAndNearestFirst) {
  const Chain chain = with_limits(laws::er20(), 2.0 * std::numbers::pi * 0.499);  // one revolution: no windings
  VectorXd q(6);
  q << 0.3, -0.4, 0.5, 0.6, 0.8, -0.2;
  const ReachTarget target = full_target(forward(chain, q));
  const VectorXd preferred = VectorXd::Zero(6);
  const ReachSolution all = ReachSolver(chain, {.choice = PostureChoice::all}).solve(target, preferred);
  ASSERT_EQ(all.status, ReachStatus::reached);
  EXPECT_EQ(all.postures.size() % 2, 0U);  // a spherical wrist has two postures
  EXPECT_GE(all.postures.size(), 4U);
  bool has_own = false;
  for (std::size_t i = 0; i < all.postures.size(); ++i) {
    expect_inside(chain, all.postures[i].q);
    EXPECT_LT((forward(chain, all.postures[i].q).position - forward(chain, q).position).norm(), 1.01e-9);
    has_own |= (all.postures[i].q - q).norm() < 1e-6;
    if (i > 0) {
      EXPECT_LE(all.postures[i - 1].distance, all.postures[i].distance);
      EXPECT_GT((all.postures[i].q - all.postures[i - 1].q).norm(), 1e-3);
    }
  }
  EXPECT_TRUE(has_own);
  const ReachSolution nearest = ReachSolver(chain, {.choice = PostureChoice::nearest}).solve(target, preferred);
  ASSERT_EQ(nearest.postures.size(), 1U);
  EXPECT_EQ(nearest.postures.front().q, all.postures.front().q);
}

TEST(Reach, RevolutionsAreRemovedTowardsThePreferredPosture) {
  const Chain chain = with_limits(laws::er20(), 3.0 * std::numbers::pi);
  const VectorXd q = VectorXd::Constant(6, 0.4);
  VectorXd preferred = q;
  preferred[5] = 0.5 + 2.0 * std::numbers::pi;
  const ReachSolution solution = ReachSolver(chain, {}).solve(full_target(forward(chain, q)), preferred);
  ASSERT_EQ(solution.status, ReachStatus::reached);
  EXPECT_NEAR(solution.postures.front().q[5], 0.4 + 2.0 * std::numbers::pi, 1e-6);
}

TEST(Reach, ARedundantArmStaysNearThePreferredPosture) {
  const Chain chain = with_limits(laws::seven_r());
  for (std::uint64_t k = 0; k < 20; ++k) {
    const VectorXd q = 0.6 * random_posture(chain, Rng(9).stream(k));
    VectorXd preferred = q;
    for (double& number : preferred) number += 0.05;
    const ReachSolution solution =
        ReachSolver(chain, {.choice = PostureChoice::nearest}).solve(full_target(forward(chain, q)), preferred);
    ASSERT_EQ(solution.status, ReachStatus::reached);
    // q itself reaches the target at this distance, so the nearest posture is no farther.
    EXPECT_LE(solution.postures.front().distance, 0.05 * std::sqrt(7.0) + 1e-3);
  }
}

TEST(Reach, TheReasonOfAFailureIsNamed) {
  Chain chain = with_limits(laws::er20());
  const ReachSolution far = ReachSolver(chain, {}).solve({Vec3(30.0, 0.0, 0.0)}, VectorXd::Zero(6));
  EXPECT_EQ(far.status, ReachStatus::out_of_reach);
  EXPECT_GT(far.position_error, 20.0);
  expect_inside(chain, far.postures.front().q);

  // Behind the base while the first joint may hardly move, and the others reach forward only.
  VectorXd q(6);
  q << 2.5, 0.2, 0.2, 0.1, 0.4, 0.1;
  const Pose tool = forward(chain, q);
  chain.joints[0].lower = -0.1, chain.joints[0].upper = 0.1;
  for (int j = 1; j < 3; ++j) chain.joints[j].lower = 0.0, chain.joints[j].upper = 0.4;
  const ReachSolution limited = ReachSolver(chain, {}).solve(full_target(tool), VectorXd::Zero(6));
  EXPECT_EQ(limited.status, ReachStatus::outside_limits);
  EXPECT_FALSE(limited.limited_joints.empty());
  expect_inside(chain, limited.postures.front().q);
}

TEST(Reach, ASequenceGoesOnFromPostureToPosture) {
  const Chain chain = with_limits(laws::er20());
  VectorXd q = VectorXd::Constant(6, 0.3);
  std::vector<ReachTarget> targets;
  for (int k = 0; k < 50; ++k) {
    q.array() += 0.02;
    targets.push_back(full_target(forward(chain, q)));
  }
  const auto solutions = reach_in_sequence(chain, targets, VectorXd::Constant(6, 0.3), {});
  VectorXd before = VectorXd::Constant(6, 0.3);
  for (const ReachSolution& solution : solutions) {
    ASSERT_EQ(solution.status, ReachStatus::reached);
    EXPECT_LT((solution.postures.front().q - before).cwiseAbs().maxCoeff(), 0.1);
    before = solution.postures.front().q;
  }
}

TEST(Reach, DoesNotDependOnTheNumberOfThreads) {
  const Chain chain = with_limits(laws::seven_r());
  std::vector<ReachTarget> targets;
  for (std::uint64_t k = 0; k < 200; ++k)
    targets.push_back(full_target(forward(chain, random_posture(chain, Rng(10).stream(k)))));
  const MatrixXd preferred = middle_posture(chain);
  const auto one = reach(chain, targets, preferred, {}, 1);
  for (const int threads : {2, 7}) {
    const auto more = reach(chain, targets, preferred, {}, threads);
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].postures.front().q, more[i].postures.front().q);
  }
}

TEST(MiddlePosture, IsTheMiddleOfTheLimitsOrZero) {
  Chain chain = laws::er20();
  for (Joint& joint : chain.joints) joint.lower = -std::numeric_limits<double>::infinity(), joint.upper = -joint.lower;
  chain.joints[1].lower = 0.5, chain.joints[1].upper = 1.5;
  chain.joints[2].lower = 0.25;
  const VectorXd middle = middle_posture(chain);
  EXPECT_EQ(middle.head<3>(), Vec3(0.0, 1.0, 0.25));
}

}  // namespace
}  // namespace kinfer::motion
