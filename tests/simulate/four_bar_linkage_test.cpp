// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/four_bar_linkage.hpp"

#include "kinfer/kinematics/frame_motion.hpp"
#include "kinfer/simulate/ground_truth.hpp"
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

TEST(FourBarLinkage, ItsClosureAndItsTruthHoldAtAllTimes) {
  const MujocoWorld world = test::world_of("excavator", {.mounting = Mounting::arbitrary}, 3);
  const Machine machine = with_linkage(world.machine());
  const MachineMotion motion = linkage_motion(machine, test::drive_of(world.machine(), {}, 3), 10.0);
  const MachineTruth truth = machine_truth(machine, motion);
  ASSERT_EQ(machine.chain.closures.size(), 1U);
  ASSERT_EQ(truth.loops.size(), 1U);
  const LoopClosure& closure = machine.chain.closures[0];
  const JointTruth& joint = truth.loops[0];
  const auto sensor = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(machine.sensors, name, &MountedSensor::name) -
                                    machine.sensors.begin());
  };
  const SensorMotion &first = motion.sensors[sensor(joint.parent)], &second = motion.sensors[sensor(joint.child)];
  for (Eigen::Index row = 0; row < motion.q.cols(); ++row) {
    const auto frames = joint_motions(machine.chain, motion.q.col(row), motion.qd.col(row), motion.qdd.col(row));
    const Pose &a = frames[static_cast<std::size_t>(closure.first)].pose,
               &b = frames[static_cast<std::size_t>(closure.second)].pose;
    ASSERT_LT((a * closure.point_in_first - b * closure.point_in_second).norm(), 1e-9);
    ASSERT_LT((a.rotation * closure.axis_in_first - b.rotation * closure.axis_in_second).norm(), 1e-9);
    const auto i = static_cast<std::size_t>(row);
    ASSERT_LT((first.position[i] + first.world_R_sensor[i] * joint.point_in_parent - second.position[i] -
               second.world_R_sensor[i] * joint.point_in_child)
                  .norm(),
              1e-9);
    ASSERT_LT((first.world_R_sensor[i] * joint.axis_in_parent - second.world_R_sensor[i] * joint.axis_in_child).norm(),
              1e-9);
  }
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
