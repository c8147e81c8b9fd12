// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/machine_from_chain.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "kinfer/identify/geometry/identified_chain.hpp"
#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/prescribed_motion.hpp"

namespace kinfer {
namespace {

/// A chain as identify writes it: sensors a, b, … in series with a joint of each type between them.
Chain chain_of(const std::vector<EstimatedJointType>& types) {
  std::vector<JointEstimate> joints;
  std::vector<DhRowEstimate> rows;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const auto letter = [](std::size_t k) { return std::string(1, static_cast<char>('a' + k)); };
    joints.push_back({.parent = letter(i), .child = letter(i + 1), .type = types[i]});
    identify::JointGeometry geometry{.axis_in_child = Vec3::UnitX(), .point_in_parent = Vec3(0.3, 0.1, 0.2)};
    geometry.home.position = Vec3(0.5, 0.0, 0.1);
    for (const DhRowEstimate& row : identify::canonical_dh_rows(joints.back(), {geometry, {}})) rows.push_back(row);
  }
  return identify::build_chain("a", joints, rows, Mat3::Identity());
}

std::vector<std::string> sensors_of(const Machine& machine) {
  std::vector<std::string> names;
  for (const MountedSensor& sensor : machine.sensors) names.push_back(sensor.name);
  return names;
}

TEST(MachineFromChain, HasTheSensorsBehindJointsOfEveryType) {
  using enum EstimatedJointType;
  const auto machine = make_machine(chain_of({universal, revolute, spherical, prismatic, rigid}));
  ASSERT_TRUE(machine) << machine.error().what;
  EXPECT_EQ(sensors_of(*machine), (std::vector<std::string>{"a", "b", "c", "d", "e", "f"}));
  for (std::size_t s = 0; s < machine->sensors.size(); ++s)
    EXPECT_EQ(machine->sensors[s].parent, static_cast<int>(s) - 1);
  EXPECT_EQ(dof(machine->chain), 7);
}

TEST(MachineFromChain, AUniversalJointAloneIsDriven) {
  const auto machine = make_machine(chain_of({EstimatedJointType::universal}));
  ASSERT_TRUE(machine) << machine.error().what;
  const auto drive = make_drive(*machine, {}, Rng(1));
  ASSERT_TRUE(drive) << drive.error().what;
  const MachineMotion motion = prescribed_motion(*machine, *drive, 20.0);
  ASSERT_EQ(motion.sensors.size(), 2U);
  double fastest = 0.0;
  for (const Vec3& rate : motion.sensors[1].angular_velocity) fastest = std::max(fastest, rate.norm());
  EXPECT_GT(fastest, 0.1);
}

TEST(MachineFromChain, AMovingJointWithoutASensorIsNamed) {
  Chain chain = chain_of({EstimatedJointType::revolute, EstimatedJointType::universal});
  for (Joint& joint : chain.joints)
    if (joint.name == "b-c 2") joint.name = "wrist";
  const auto machine = make_machine(chain);
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().what, "joint b-c 1: it leads to no sensor; expected a chain written by identify");
}

}  // namespace
}  // namespace kinfer
