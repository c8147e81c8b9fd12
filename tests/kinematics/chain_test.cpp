// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/chain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinfer/base/constants.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Chain, APathLeadsFromTheBaseToTheTipPastOtherBranches) {
  const Chain chain = laws::two_arms();
  EXPECT_THAT(path_to(chain, 3), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(path_to(chain, 5), ElementsAre(0, 4, 5));
  EXPECT_THAT(path_to(chain, -1), IsEmpty());
}

TEST(Chain, JointPositionsBelongToActiveJoints) {
  EXPECT_EQ(dof(laws::urdf_arm()), 5);  // two of seven are fixed
  EXPECT_THAT(active_joints(laws::urdf_arm()), ElementsAre(1, 2, 3, 5, 6));
  EXPECT_THAT(active_joint_names(laws::urdf_arm()), ElementsAre("J2", "J3", "J4", "J6", "J7"));
  EXPECT_EQ(dof(laws::coupled()), 6);  // the mimic joint has none
  EXPECT_THAT(active_joint_indices(laws::urdf_arm()), ElementsAre(-1, 0, 1, 2, -1, 3, 4));
}

TEST(Chain, TheLastJointCarriesTheToolUnlessAnotherIsNamed) {
  EXPECT_EQ(laws::er20().tip_joint(), 5);
  EXPECT_EQ(laws::two_arms().tip_joint(), 3);
  EXPECT_EQ(laws::without_joints().tip_joint(), -1);
}

TEST(Chain, EveryExampleIsWellFormed) {
  for (const Chain& chain : laws::examples()) expect_well_formed(chain);
}

TEST(Chain, AMalformedChainStopsTheProgram) {
  Chain chain = laws::er20();
  chain.joints[2].parent = 2;
  EXPECT_DEATH(expect_well_formed(chain), "parent 2 of joint 2");
  chain = laws::er20();
  chain.tip = 6;
  EXPECT_DEATH(expect_well_formed(chain), "tip 6 of 6 joints");
  chain = laws::coupled();
  chain.joints[1].couplings = {{6, 1.0}};  // a mimic joint cannot be a leader
  EXPECT_DEATH(expect_well_formed(chain), "joint 1 coupled to 6");
  chain = laws::urdf_arm();
  std::get<UrdfLink>(chain.joints[2].link).axis = Vec3(0, 2, 0);
  EXPECT_DEATH(expect_well_formed(chain), "axis of joint 2 has length 2");
  chain = laws::compliant();
  chain.masses[0].joint = 9;
  EXPECT_DEATH(expect_well_formed(chain), "mass on joint 9 of 6");
  EXPECT_DEATH(forward(laws::er20(), VectorXd::Zero(5)), "5 joint positions for 6 joints");
}

TEST(Chain, TheEr20HasTheReachOfItsTable) {
  // Paper 2, table 1, by hand: at q = 0 link 2 points along x1 and the wrist hangs down along -z0.
  Chain chain = laws::er20();
  chain.base = chain.tool = Frame{};
  const Pose flange = forward(chain, VectorXd::Zero(6));
  EXPECT_LT((flange.position - Vec3(0.166605 + 0.782270 + 0.138826, 0, 0.504 - 0.76135 - 0.125)).norm(), 1e-15);
}

TEST(Chain, TheTorqueOfAHorizontalArmIsTheMomentOfItsMasses) {
  Chain chain;
  chain.joints = {laws::revolute<DhLink>(0.6, 90, 0), laws::revolute<DhLink>(0.4, 0, 0)};
  chain.joints[1].parent = 0;
  chain.masses = {{1, {-0.1, 0, 0}, 2.0}};  // 0.3 m beyond joint 2
  // Joint 1 is vertical and has no torque; joint 2 lifts: g (2 · 0.3 + 5 · 0.4) against its sense.
  const VectorXd torques = gravity_torques(chain, VectorXd::Zero(2), {.payload = 5.0});
  EXPECT_NEAR(torques[0], 0.0, 1e-14);
  EXPECT_NEAR(torques[1], -standard_gravity * (2.0 * 0.3 + 5.0 * 0.4), 1e-12);
  chain.joints[1].compliance = 1e-4;
  const Pose sagged = forward(chain, VectorXd::Zero(2), {.payload = 5.0});
  EXPECT_NEAR(sagged.position.z(), -0.4 * std::sin(1e-4 * standard_gravity * 2.6), 1e-15);
}

}  // namespace
}  // namespace kinfer
