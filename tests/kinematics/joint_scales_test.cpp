// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/joint_scales.hpp"

#include <gtest/gtest.h>

#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

MatrixXd two_postures(double angle, double length, Eigen::Index of_length) {
  MatrixXd q = MatrixXd::Zero(4, 2);
  q.col(1).setConstant(angle);
  q(of_length, 1) = length;
  return q;
}

TEST(JointScales, ALockedJointHasTheUnitOfThoseThatMove) {
  MatrixXd q = MatrixXd::Zero(6, 2);
  q.col(1) << 1.0, 2.0, 1e-5, 0.5, 0.0, 0.1;
  EXPECT_EQ(joint_scales(laws::er20(), q), VectorXd::Constant(6, 2.0));
}

TEST(JointScales, AnglesThatScatterAreComparedWithAThousandthOfARadian) {
  MatrixXd q = MatrixXd::Zero(6, 2);
  q.col(1).setConstant(1e-5);
  EXPECT_EQ(joint_scales(laws::er20(), q), VectorXd::Constant(6, 1e-3));
}

TEST(JointScales, EachKindHasAUnitOfItsOwn) {
  const Chain scara = laws::scara();
  const std::vector<int> moving = active_joints(scara);
  Eigen::Index slide = -1;
  for (std::size_t k = 0; k < moving.size(); ++k)
    if (translates(scara.joints[static_cast<std::size_t>(moving[k])].type)) slide = static_cast<Eigen::Index>(k);
  ASSERT_EQ(moving.size(), 4U);
  ASSERT_GE(slide, 0);
  const VectorXd scale = joint_scales(scara, two_postures(1.5, 0.4, slide));
  for (Eigen::Index k = 0; k < 4; ++k) EXPECT_DOUBLE_EQ(scale[k], k == slide ? 0.4 : 1.5);
  const VectorXd locked = joint_scales(scara, two_postures(1.5, 1e-6, slide));
  EXPECT_GT(locked[slide], 0.01) << "a slide whose readings scatter is compared with what the tool moves";
}

}  // namespace
}  // namespace kinfer
