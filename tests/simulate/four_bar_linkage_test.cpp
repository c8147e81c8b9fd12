// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/four_bar_linkage.hpp"

#include "kinfer/kinematics/frame_motion.hpp"
#include "simulate/worlds.hpp"

namespace kinfer {
namespace {

TEST(FourBarLinkage, ItsCouplerHoldsOneAndTheSamePointOfTheLastSegment) {
  const MujocoWorld world = test::world_of("excavator", {.mounting = Mounting::arbitrary}, 2);
  const FourBar bars;
  const Machine machine = with_linkage(world.machine(), bars);
  const MachineMotion motion = linkage_motion(machine, test::drive_of(world.machine(), {}, 2), 20.0);
  const std::size_t coupler = machine.chain.joints.size() - 1, rocker = coupler - 1;
  const auto tool = static_cast<std::size_t>(machine.sensors[machine.sensors.size() - 3].joint);
  Vec3 first = Vec3::Zero();
  for (Eigen::Index row = 0; row < motion.q.cols(); ++row) {
    const auto frames = joint_motions(machine.chain, motion.q.col(row), motion.qd.col(row), motion.qdd.col(row));
    const Pose &held = frames[coupler].pose, &holding = frames[tool].pose;
    const Vec3 end = held.position + held.rotation * Vec3(bars.coupler, 0.0, 0.0);
    const Vec3 in_tool = holding.rotation.transpose() * (end - holding.position);
    if (row == 0) first = in_tool;
    ASSERT_LT((in_tool - first).norm(), 1e-9) << row;
    ASSERT_NEAR((frames[rocker].pose.position - held.position).norm(), bars.rocker, 1e-9);
  }
  EXPECT_NEAR(first.norm(), bars.crank, 1e-9);
}

TEST(FourBarLinkage, TheVelocitiesAreTheDerivativesOfTheJointPositions) {
  const MujocoWorld world = test::world_of("excavator", {}, 2);
  const Machine machine = with_linkage(world.machine());
  const MachineMotion motion = linkage_motion(machine, test::drive_of(world.machine(), {}, 2), 1000.0);
  for (Eigen::Index row = 30000; row < 30100; ++row) {
    const VectorXd rate = 500.0 * (motion.q.col(row + 1) - motion.q.col(row - 1));
    EXPECT_LT((rate - motion.qd.col(row)).norm(), 1e-4);
    const VectorXd change = 500.0 * (motion.qd.col(row + 1) - motion.qd.col(row - 1));
    EXPECT_LT((change - motion.qdd.col(row)).norm(), 1e-3);
  }
}

}  // namespace
}  // namespace kinfer
