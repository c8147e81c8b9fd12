// SPDX-License-Identifier: Apache-2.0
// The drawn frames are those of the chain: every convention, through JSON and back.
#include "kinfer/report/parts/chain_view.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kinfer/base/rng.hpp"
#include "kinfer/io/evidence/drawing_json.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

class ChainViews : public ::testing::TestWithParam<Chain> {};

TEST_P(ChainViews, FramesFromEvidenceAreThoseOfTheChain) {
  Chain chain = GetParam();
  for (Joint& joint : chain.joints) joint.compliance = 0.0;  // a drawing ignores deflections
  const ChainView view = chain_view(nlohmann::json::parse(chain_json(chain).dump()));
  Rng rng(7);
  for (int trial = 0; trial < 5; ++trial) {
    VectorXd q(dof(chain));
    for (double& value : q) value = rng.uniform(-2.0, 2.0);
    const auto drawn = placed(view, {q.begin(), q.end()});
    const std::vector<Pose> frames = joint_frames(chain, q);
    ASSERT_EQ(drawn.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_LT((drawn[i].frame.position - frames[i].position).norm(), 1e-12);
      EXPECT_LT((drawn[i].frame.rotation - frames[i].rotation).norm(), 1e-12);
    }
    const Pose tool = forward(chain, q);
    EXPECT_LT((tool_pose(view, drawn).position - tool.position).norm(), 1e-12);
  }
}

TEST_P(ChainViews, AxesAreTheLinesThatJointsMoveAbout) {
  const Chain& chain = GetParam();
  const VectorXd q = VectorXd::Constant(dof(chain), 0.3);
  const auto drawn = placed(chain_view(nlohmann::json::parse(chain_json(chain).dump())), {q.begin(), q.end()});
  Chain stiff = chain;
  for (Joint& joint : stiff.joints) joint.compliance = 0.0;
  const std::vector<JointPlacement> truth = joint_placements(stiff, q);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT((drawn[i].axis - truth[i].axis).norm(), 1e-12);
    EXPECT_LT(truth[i].axis.cross(drawn[i].point - truth[i].point).norm(), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ChainViews, ::testing::ValuesIn(laws::examples()));

}  // namespace
}  // namespace kinfer
