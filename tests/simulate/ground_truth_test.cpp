// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/ground_truth.hpp"

#include <gtest/gtest.h>

#include "kinfer/simulate/prescribed_motion.hpp"
#include "simulate/worlds.hpp"

namespace kinfer {
namespace {

using test::drive_of;
using test::world_of;

std::size_t index_of(const Machine& machine, const std::string& sensor) {
  for (std::size_t s = 0; s < machine.sensors.size(); ++s)
    if (machine.sensors[s].name == sensor) return s;
  ADD_FAILURE() << sensor;
  return 0;
}

TEST(GroundTruth, BothSensorsOfAJointHaveTheSameAxisLineAtAllTimes) {
  for (const std::string& name : machine_names()) {
    const MujocoWorld world = world_of(name, {.base = Base::yawing}, 2);
    const Machine& machine = world.machine();
    const MachineMotion motion = test::driven(world, drive_of(machine, {.duration = 20.0}), 20.0);
    const MachineTruth truth = machine_truth(machine, motion);
    ASSERT_EQ(truth.joints.size(), machine.sensors.size() - 1);
    const std::vector<std::string> readings = active_joint_names(machine.chain);
    for (const JointTruth& joint : truth.joints) {
      const SensorMotion &parent = motion.sensors[index_of(machine, joint.parent)],
                         &child = motion.sensors[index_of(machine, joint.child)];
      const auto reading = std::ranges::find(readings, joint.name) - readings.begin();
      for (std::size_t row = 0; row < motion.time.size(); ++row) {
        const double q = motion.q(reading, static_cast<Eigen::Index>(row));
        const Vec3 axis = parent.world_R_sensor[row] * joint.axis_in_parent;
        const Vec3 from_parent = parent.position[row] + parent.world_R_sensor[row] * joint.point_in_parent;
        const Vec3 from_child = child.position[row] + child.world_R_sensor[row] * joint.point_in_child;
        ASSERT_LT((axis - child.world_R_sensor[row] * joint.axis_in_child).norm(), 1e-9) << name << " " << joint.name;
        const Vec3 slid = joint.type == JointType::prismatic ? Vec3(q * axis) : Vec3::Zero();
        ASSERT_LT((from_child - from_parent - slid).norm(), 1e-9) << name << " " << joint.name;
      }
    }
  }
}

TEST(GroundTruth, PositiveJointAngleRotatesTheChildAboutTheAxisByTheRightHand) {
  const MujocoWorld world = world_of("robot6");
  const MachineMotion motion = prescribed_motion(world.machine(), drive_of(world.machine()), 100.0);
  for (const JointTruth& joint : machine_truth(world.machine(), motion).joints) {
    const std::size_t p = index_of(world.machine(), joint.parent), c = index_of(world.machine(), joint.child);
    for (std::size_t row = 0; row < motion.time.size(); row += 7) {
      const Vec3 relative = motion.sensors[c].world_R_sensor[row] * motion.sensors[c].angular_velocity[row] -
                            motion.sensors[p].world_R_sensor[row] * motion.sensors[p].angular_velocity[row];
      const Vec3 axis = motion.sensors[c].world_R_sensor[row] * joint.axis_in_child;
      const auto reading = static_cast<Eigen::Index>(c) - 1;
      ASSERT_NEAR(relative.dot(axis), motion.qd(reading, static_cast<Eigen::Index>(row)), 1e-12);
    }
  }
}

TEST(GroundTruth, ExcavatorsLeverArmsAreThePapers) {
  const MujocoWorld world = world_of("excavator");
  const MachineTruth truth =
      machine_truth(world.machine(), prescribed_motion(world.machine(), drive_of(world.machine()), 20.0));
  ASSERT_EQ(truth.joints.size(), 5u);
  EXPECT_EQ(truth.root, "ins0");
  const Vec3 parents[] = {{0, 0, 0}, {0.4, 0, 0}, {1.285, 0, 0}, {1.62, 0, 0}, {1.45, 0, 0}};
  const Vec3 children[] = {{1.25, 0, 0}, {-0.58, 0, 0}, {-0.33, 0, 0}, {-0.75, 0, 0}, {-0.42, 0, 0}};
  const Vec3 axes[] = {{0, 0, 1}, {0, -1, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  for (std::size_t j = 0; j < 5; ++j) {
    EXPECT_LT((truth.joints[j].point_in_parent - parents[j]).norm(), 1e-12) << j;
    EXPECT_LT((truth.joints[j].point_in_child - children[j]).norm(), 1e-12) << j;
    EXPECT_LT((truth.joints[j].axis_in_parent - axes[j]).norm(), 1e-12) << j;
    EXPECT_LT((truth.joints[j].axis_in_child - Vec3::UnitZ()).norm(), 1e-12) << j;
  }
  const double lengths[] = {0.85, 1.865, 1.95, 2.2};
  ASSERT_EQ(truth.links.size(), 4u);
  for (std::size_t l = 0; l < 4; ++l) EXPECT_NEAR(truth.links[l].length, lengths[l], 1e-12);
}

MachineTruth truth_of(const MachineOptions& options) {
  const MujocoWorld world = world_of("excavator", options);
  return machine_truth(world.machine(), prescribed_motion(world.machine(), drive_of(world.machine()), 20.0));
}

TEST(GroundTruth, AStationaryPlatformsJointAndTheHousesAxialOffsetAreUnobservable) {
  const MachineTruth truth = truth_of({});
  EXPECT_EQ(truth.joints[0].unobservable_in_parent.size(), 3u);
  ASSERT_EQ(truth.joints[0].unobservable_in_child.size(), 1u);
  EXPECT_NEAR(std::abs(truth.joints[0].unobservable_in_child[0].z()), 1.0, 1e-9);
  EXPECT_EQ(truth.joints[1].unobservable_in_parent.size(), 1u);
  EXPECT_EQ(truth.joints[1].unobservable_in_child.size(), 0u);
  EXPECT_FALSE(truth.joints[0].is_axial_offset_observable);
  EXPECT_TRUE(truth.joints[1].is_axial_offset_observable);
  EXPECT_TRUE(truth.joints[0].heading_needs_magnetometer);
  EXPECT_FALSE(truth.joints[1].heading_needs_magnetometer);
}

TEST(GroundTruth, ASlopeMakesTheAzimuthObservableAndARockingBaseEverything) {
  const MachineTruth sloping = truth_of({.slope = Angle::deg(5)});
  EXPECT_FALSE(sloping.joints[0].heading_needs_magnetometer);
  EXPECT_EQ(sloping.joints[0].unobservable_in_parent.size(), 3u);
  for (const JointTruth& joint : truth_of({.base = Base::rocking}).joints) {
    EXPECT_TRUE(joint.unobservable_in_parent.empty() && joint.unobservable_in_child.empty()) << joint.name;
    EXPECT_TRUE(joint.is_axial_offset_observable) << joint.name;
  }
}

TEST(GroundTruth, TreeHasTwoArmsOnItsTorso) {
  const MujocoWorld world = world_of("tree");
  std::vector<std::string> pairs;
  for (const JointTruth& joint :
       machine_truth(world.machine(), prescribed_motion(world.machine(), drive_of(world.machine()), 20.0)).joints)
    pairs.push_back(joint.parent + "-" + joint.child);
  EXPECT_EQ(pairs, (std::vector<std::string>{"ins0-ins1", "ins1-ins2", "ins2-ins3", "ins1-ins4", "ins4-ins5"}));
}

}  // namespace
}  // namespace kinfer
