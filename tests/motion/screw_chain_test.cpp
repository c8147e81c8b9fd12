// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/screw_chain.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "laws/example_chains.hpp"

namespace kinfer::motion {
namespace {

/// What a rigid chain leaves out.
Chain without_deviations(Chain chain) {
  chain.masses.clear();
  for (Joint& joint : chain.joints) joint.compliance = joint.torque_compliance = 0.0, joint.harmonics.clear();
  return chain;
}

class ScrewChainLaws : public ::testing::TestWithParam<Chain> {};

TEST_P(ScrewChainLaws, ToolPoseAndJacobianAreThoseOfTheChain) {
  const Chain chain = without_deviations(GetParam());
  const ScrewChain screws(chain);
  ASSERT_EQ(screws.dof(), dof(chain));
  ScrewChain::Placement at;
  Twists twists;
  for (std::uint64_t k = 0; k < 20; ++k) {
    const VectorXd q = laws::random_q(chain, Rng(3).stream(k));
    screws.place(q, at);
    screws.jacobian(at, twists);
    const Pose tool = forward(chain, q);
    EXPECT_LT((at.tool.position - tool.position).norm(), 1e-12);
    EXPECT_LT((at.tool.rotation - tool.rotation).norm(), 1e-12);
    EXPECT_LT((twists - jacobian(chain, q)).norm(), 1e-11);
  }
}

TEST_P(ScrewChainLaws, APeriodBringsTheToolBack) {
  const Chain chain = without_deviations(GetParam());
  const ScrewChain screws(chain);
  VectorXd q = laws::random_q(chain, Rng(4));
  const Pose tool = forward(chain, q);
  for (int k = 0; k < screws.dof(); ++k) q[k] += 2.0 * screws.period(k);
  EXPECT_LT((forward(chain, q).position - tool.position).norm(), 1e-11);
  EXPECT_LT((forward(chain, q).rotation - tool.rotation).norm(), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(all, ScrewChainLaws, ::testing::ValuesIn(laws::examples_with_joints()),
                         [](const auto& test) { return laws::test_name(test.param); });

TEST(ScrewChain, AJointThatAnotherFollowsHasNoPeriod) {
  Chain chain = laws::er20();
  chain.joints[2].couplings.push_back({1, 0.5});
  const ScrewChain screws(chain);
  EXPECT_EQ(screws.period(1), 0.0);
  EXPECT_DOUBLE_EQ(screws.period(3), 2.0 * std::numbers::pi);
}

}  // namespace
}  // namespace kinfer::motion
