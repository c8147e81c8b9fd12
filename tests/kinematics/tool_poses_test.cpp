// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/poses/tool_poses.hpp"

#include <gtest/gtest.h>

#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using RowMajorPose = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

MatrixXd random_positions(const Chain& chain, Index count) {
  MatrixXd q(dof(chain), count);
  for (Index i = 0; i < count; ++i) q.col(i) = laws::random_q(chain, Rng(static_cast<std::uint64_t>(i)));
  return q;
}

std::vector<double> all_poses(const Chain& chain, const MatrixXd& q, int threads) {
  std::vector<double> poses(static_cast<std::size_t>(16 * q.cols()), -1.0);
  tool_poses(chain, q, poses, threads);
  return poses;
}

TEST(ToolPoses, AreThoseOfForwardColumnByColumn) {
  for (const Chain& chain : laws::examples_with_joints()) {
    const MatrixXd q = random_positions(chain, 7);
    const auto poses = all_poses(chain, q, 1);
    for (Index i = 0; i < q.cols(); ++i) {
      const Eigen::Map<const RowMajorPose> found(poses.data() + 16 * i);
      const Pose expected = forward(chain, q.col(i));
      EXPECT_LT((found.topLeftCorner<3, 3>() - expected.rotation).norm(), 1e-13) << chain.name;
      EXPECT_LT((found.topRightCorner<3, 1>() - expected.position).norm(), 1e-13) << chain.name;
      EXPECT_EQ(found.row(3), Eigen::RowVector4d(0, 0, 0, 1)) << chain.name;
    }
  }
}

TEST(ToolPoses, DoNotDependOnTheThreadsThatShareTheWork) {
  const Chain chain = laws::scara();
  const MatrixXd q = random_positions(chain, 4096 + 5);  // more than one work item, the last one short
  const auto alone = all_poses(chain, q, 1);
  EXPECT_EQ(all_poses(chain, q, 3), alone);
  EXPECT_EQ(std::ranges::count(alone, -1.0), 0) << "a number was not written";
}

TEST(ToolPoses, OfNoJointPositionsAreNone) {
  EXPECT_TRUE(all_poses(laws::er20(), MatrixXd(6, 0), 2).empty());
}

TEST(ToolPoses, OfAChainWithoutJointsAreItsToolOnItsBase) {
  const Chain chain = laws::without_joints();
  const auto poses = all_poses(chain, MatrixXd(0, 3), 1);
  const Pose expected = chain.base.pose() * chain.tool.pose();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(poses[16 * i + 7], expected.position.y(), 1e-15);
}

TEST(ToolPoses, AMatrixOfAnotherSizeStopsTheProgram) {
  std::vector<double> poses(16);
  EXPECT_DEATH(tool_poses(laws::er20(), MatrixXd::Zero(5, 1), poses, 1), "5 x 1 joint positions, 16 numbers");
  EXPECT_DEATH(tool_poses(laws::er20(), MatrixXd::Zero(6, 2), poses, 1), "6 x 2 joint positions, 16 numbers");
}

}  // namespace
}  // namespace kinfer
