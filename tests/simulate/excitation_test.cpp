// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/excitation.hpp"

#include <gtest/gtest.h>

#include "simulate/worlds.hpp"

namespace kinfer {
namespace {

using test::drive_of;
using test::world_of;

constexpr double step = 0.01;  // [s]

struct Extremes {
  double lowest, highest, fastest;
};

Extremes extremes(const JointTrajectory& joint, double begin, double end) {
  Extremes seen{joint.home, joint.home, 0.0};
  for (double t = begin; t < end; t += step) {
    const JointState state = state_at(joint, t);
    seen = {std::min(seen.lowest, state.q), std::max(seen.highest, state.q),
            std::max(seen.fastest, std::abs(state.qd))};
  }
  return seen;
}

TEST(Excitation, VelocitiesAndAccelerationsAreTheDerivativesOfTheAngles) {
  const Drive drive = drive_of(world_of("tree").machine());
  constexpr double h = 1e-4;
  for (const JointTrajectory& joint : drive.joints)
    for (double t = 0.0; t < drive.duration; t += 0.0371) {
      const JointState before = state_at(joint, t - h), now = state_at(joint, t), after = state_at(joint, t + h);
      ASSERT_NEAR(now.qd, (after.q - before.q) / (2 * h), 1e-6);
      ASSERT_NEAR(now.qdd, (after.qd - before.qd) / (2 * h), 1e-5);
    }
}

TEST(Excitation, StandardDriveRestsThenMovesJointAfterJointThenAll) {
  const Machine machine = world_of("excavator").machine();
  const Drive drive = drive_of(machine);
  EXPECT_DOUBLE_EQ(drive.duration, 4.0 + 5 * 6.5 + 16.5 + 0.5);
  ASSERT_EQ(drive.phases.size(), 8u);
  for (std::size_t k = 0; k < drive.joints.size(); ++k) {
    for (const Phase& phase : drive.phases) {
      const Extremes seen = extremes(drive.joints[k], phase.begin, phase.end);
      const bool moves = phase.what == "all" || phase.what == active_joint_names(machine.chain)[k];
      EXPECT_EQ(moves, seen.fastest > 0.2) << k << " in " << phase.what;
      EXPECT_EQ(!moves, seen.fastest == 0.0) << k << " in " << phase.what;
    }
  }
}

TEST(Excitation, JointsKeepTheirLimitsAndSpeedsWhateverTheScript) {
  for (const std::string& name : machine_names()) {
    const Machine machine = world_of(name).machine();
    for (const Script script : {Script::standard, Script::together, Script::vigorous, Script::gentle}) {
      const Drive drive = drive_of(machine, {.script = script}, 9);
      const double size = script == Script::vigorous ? 1.8 : script == Script::gentle ? 0.45 : 1.0;
      for (std::size_t k = 0; k < drive.joints.size(); ++k) {
        const Joint& joint = machine.chain.joints[active_joints(machine.chain)[k]];
        const Extremes seen = extremes(drive.joints[k], 0.0, drive.duration);
        EXPECT_GT(seen.lowest, joint.lower) << name << " " << joint.name;
        EXPECT_LT(seen.highest, joint.upper) << name << " " << joint.name;
        EXPECT_LT(seen.fastest, 1.0001 * size * (joint.type == JointType::revolute ? 0.8 : 0.5))
            << name << " " << joint.name;
      }
    }
  }
}

TEST(Excitation, DurationIsKeptAndOneThatIsTooShortIsRefused) {
  const Machine machine = world_of("excavator").machine();
  for (const Script script : {Script::standard, Script::sequential, Script::together})
    EXPECT_NEAR(drive_of(machine, {.script = script, .duration = 60.0}).duration, 60.0, 1e-9);
  const auto short_drive = make_drive(machine, {.duration = 6.0}, Rng(1));
  ASSERT_FALSE(short_drive);
  EXPECT_EQ(short_drive.error().what, "a duration of 6 s is too short for this script: 15.2 s at least");
}

TEST(Excitation, BaseMovesFromTheFirstRestToTheLast) {
  const Machine machine = world_of("crane", {.base = Base::rocking}).machine();
  ASSERT_EQ(machine.base_dof, 3);
  const Drive drive = drive_of(machine);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(extremes(drive.joints[k], 0.0, 4.0).fastest, 0.0);
    EXPECT_GT(extremes(drive.joints[k], 4.0, drive.duration - 1.0).fastest, 0.02);
    EXPECT_EQ(extremes(drive.joints[k], drive.duration - 1.0, drive.duration).fastest, 0.0);
  }
}

}  // namespace
}  // namespace kinfer
