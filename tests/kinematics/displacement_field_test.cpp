// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/displacement_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/inverse.hpp"
#include "support/differences.hpp"
#include "support/instruments.hpp"
#include "support/random_field.hpp"

namespace kinfer {
namespace {

using namespace test;

Chain displaced_robot() {
  Chain chain = nominal_robot();
  chain.base = Frame::from_pose(Pose::from_xyz_rpy({0.4, -0.3, 0.2}, {0.3, -0.2, 1.5}));
  chain.field = random_field(dof(chain), 7, Rng(3));
  return chain;
}

Chain without_field(Chain chain) {
  chain.field = {};
  return chain;
}

TEST(DisplacementField, IsTheSumOverItsPoints) {
  const DisplacementField field = random_field(2, 2, Rng(1));
  const VectorXd q = (VectorXd(2) << 0.3, -0.2).finished();
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 2; ++k) {
    const double a = (q[0] - field.points(0, k)) / field.length[0], b = (q[1] - field.points(1, k)) / field.length[1];
    sum += std::exp(-0.5 * (a * a + b * b)) * field.coefficients.col(k);
  }
  EXPECT_LT((displacement_at(field, q) - sum).norm(), 1e-18);
  EXPECT_EQ(displacement_at({}, q), Vec3::Zero());
}

TEST(DisplacementField, IsGoneFarFromAllPoints) {
  const DisplacementField field = random_field(6, 50, Rng(1));
  EXPECT_LT(displacement_at(field, VectorXd::Constant(6, 9.0)).norm(), 1e-12);
}

TEST(DisplacementField, MovesTheToolAlongTheAxesOfTheBaseAndTurnsNothing) {
  const Chain chain = displaced_robot();
  const VectorXd q = 0.3 * VectorXd::LinSpaced(6, -1.0, 1.0);
  const Pose with = forward(chain, q), without = forward(without_field(chain), q);
  const Vec3 expected = chain.base.pose().rotation * displacement_at(chain.field, q);
  EXPECT_GT(expected.norm(), 1e-5);
  EXPECT_LT((with.position - without.position - expected).norm(), 1e-15);
  EXPECT_EQ(with.rotation, without.rotation);
  EXPECT_LT((PoseEvaluator(chain, {}).pose(q).position - with.position).norm(), 1e-14);
}

TEST(DisplacementField, TheJacobianIsTheSlope) {
  const Chain chain = displaced_robot();
  const VectorXd q = 0.3 * VectorXd::LinSpaced(6, -1.0, 1.0);
  const Twists twists = jacobian(chain, q);
  for (int j = 0; j < 6; ++j) {
    constexpr double step = 1e-6;
    VectorXd above = q, below = q;
    above[j] += step, below[j] -= step;
    const Vec3 slope = (forward(chain, above).position - forward(chain, below).position) / (2.0 * step);
    EXPECT_LT((twists.col(j).head<3>() - slope).norm(), 1e-8) << j;
  }
}

TEST(DisplacementField, TheInverseReachesTheDisplacedTool) {
  const Chain chain = displaced_robot();
  const VectorXd q = (VectorXd(6) << 0.2, -0.4, 0.3, 0.5, 0.6, -0.2).finished();
  const InverseSolution solution = inverse(chain, forward(without_field(chain), q), q);
  EXPECT_LT((forward(chain, solution.q).position - forward(without_field(chain), q).position).norm(), 1e-7);
}

}  // namespace
}  // namespace kinfer
