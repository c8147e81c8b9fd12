// SPDX-License-Identifier: Apache-2.0
#include "identify/rail_machine.hpp"

#include <gtest/gtest.h>

#include "kinfer/identify/pipeline.hpp"

namespace kinfer {
using namespace identify;
namespace {

Identification identified_rail(double travel, std::uint64_t seed, std::vector<std::string> sensors = {}) {
  const test::RailMachine machine(travel, seed);
  const auto found = identify_machine(machine.recording, {.sensors = std::move(sensors)}, Rng(1));
  EXPECT_TRUE(found) << found.error().what;
  return found ? *found : Identification{};
}

TEST(RailMachine, ACarriageThatNeverRotatesIsAPrismaticJointOfABaseAtRest) {
  const test::RailMachine machine(0.4, 1);
  const Identification found = identified_rail(0.4, 1);
  EXPECT_TRUE(found.findings.empty());
  ASSERT_EQ(found.joints.size(), 2U);
  const JointEstimate &rail = found.joints[0], &arm = found.joints[1];
  EXPECT_EQ(rail.type, EstimatedJointType::prismatic);
  EXPECT_EQ(arm.type, EstimatedJointType::revolute);
  const Vec3 axis = machine.bodies[1].child_R_axis.col(2);
  EXPECT_LT(rail.axis_in_child.cross(axis).norm(), 3e-3);
  const Vec3 error = arm.point_in_child - machine.bodies[2].point_in_child;
  EXPECT_LT(error.cross(machine.bodies[2].child_R_axis.col(2)).norm(), 2e-3);
  for (const JointVerdict& verdict : found.verdicts) EXPECT_GE(verdict.connection.gain(), 1.5) << verdict.joint;
}

TEST(RailMachine, AGyroscopeThatHardlyTurnsIsNotSaidToReadTooLittle) {
  const Identification found = identified_rail(0.4, 1, {"carriage", "arm"});  // the base has no sensor
  EXPECT_TRUE(found.findings.empty()) << name(found.findings[0].kind);
  ASSERT_EQ(found.joints.size(), 1U);
  EXPECT_EQ(found.joints[0].type, EstimatedJointType::revolute);
}

}  // namespace
}  // namespace kinfer
