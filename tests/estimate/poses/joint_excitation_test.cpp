// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/joint_excitation.hpp"

#include <gtest/gtest.h>

#include "support/robots.hpp"

namespace kinfer {
namespace {

PoseSet two_rows() {
  PoseSet set;
  set.joints = MatrixXd::Zero(6, 2);
  set.joints(1, 1) = 0.5;
  return set;
}

TEST(JointExcitation, IsTheRangeOfEachJointByTheChainsNameWhereTheSetHasNone) {
  Chain chain = test::er20();
  chain.joints[1].name = "shoulder";
  const auto joints = measure_joint_excitation(chain, two_rows());
  ASSERT_EQ(joints.size(), 6U);
  EXPECT_EQ(joints[1].name, "shoulder");
  EXPECT_EQ(joints[1].lower, 0.0);
  EXPECT_EQ(joints[1].upper, 0.5);
  EXPECT_EQ(joints[0].sd, 0.0);
}

TEST(JointExcitation, OfNoRowsIsNothing) {
  PoseSet none = two_rows();
  none.joints.resize(6, 0);
  EXPECT_TRUE(measure_joint_excitation(test::er20(), none).empty());
}

}  // namespace
}  // namespace kinfer
