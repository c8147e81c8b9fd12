// SPDX-License-Identifier: Apache-2.0
// The view of a chain moves as the chain does, in every convention.
#include "kinfer/kinematics/chain_view.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

class ChainViews : public ::testing::TestWithParam<Chain> {
 protected:
  /// A view leaves deflections out.
  static Chain stiff_chain() {
    Chain chain = GetParam();
    for (Joint& joint : chain.joints) joint.compliance = 0.0;
    return chain;
  }
};

TEST_P(ChainViews, FramesOfTheViewAreThoseOfTheChain) {
  const Chain chain = stiff_chain();
  const ChainView view = chain_view(chain);
  Rng rng(7);
  for (int trial = 0; trial < 5; ++trial) {
    VectorXd q(dof(chain));
    for (double& value : q) value = rng.uniform(-2.0, 2.0);
    const auto drawn = place_joints(view, {q.begin(), q.end()});
    const std::vector<Pose> frames = joint_frames(chain, q);
    ASSERT_EQ(drawn.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_LT((drawn[i].frame.position - frames[i].position).norm(), 1e-12);
      EXPECT_LT((drawn[i].frame.rotation - frames[i].rotation).norm(), 1e-12);
    }
    EXPECT_LT((tool_pose(view, drawn).position - forward(chain, q).position).norm(), 1e-12);
  }
}

TEST_P(ChainViews, AxesAreTheLinesThatJointsMoveAbout) {
  const Chain chain = stiff_chain();
  const VectorXd q = VectorXd::Constant(dof(chain), 0.3);
  const auto drawn = place_joints(chain_view(chain), {q.begin(), q.end()});
  const std::vector<JointPlacement> truth = joint_placements(chain, q);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT((drawn[i].axis - truth[i].axis).norm(), 1e-12);
    EXPECT_LT(truth[i].axis.cross(drawn[i].point - truth[i].point).norm(), 1e-12);
  }
}

TEST_P(ChainViews, JointPositionsThatAreMissingCountAsZero) {
  const Chain chain = stiff_chain();
  const ChainView view = chain_view(chain);
  const Pose tool = tool_pose(view, place_joints(view, {}));
  EXPECT_LT((tool.position - forward(chain, VectorXd::Zero(dof(chain))).position).norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(All, ChainViews, ::testing::ValuesIn(laws::examples()));

TEST(ChainView, LimitsAreThoseWithBothSides) {
  Chain chain = laws::serial("two", {laws::revolute<DhLink>(0.1, 0.0, 0.2), laws::revolute<DhLink>(0.1, 0.0, 0.2)});
  chain.joints[0].lower = -1.0, chain.joints[0].upper = 2.0;
  chain.joints[1].lower = -1.0, chain.joints[1].upper = std::numeric_limits<double>::infinity();
  const ChainView view = chain_view(chain);
  EXPECT_EQ(view.joints[0].limits, (std::array<double, 2>{-1.0, 2.0}));
  EXPECT_FALSE(view.joints[1].limits);
}

TEST(ChainView, APoseComesBackFromItsQuaternion) {
  const Pose pose = Pose::from_xyz_rpy({0.1, 0.2, 0.3}, {0.4, -1.0, 3.0});
  const Pose back = view_pose(pose).pose();
  EXPECT_LT((back.rotation - pose.rotation).norm(), 1e-14);
  EXPECT_EQ(back.position, pose.position);
}

}  // namespace
}  // namespace kinfer
