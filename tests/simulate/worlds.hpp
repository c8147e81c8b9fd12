// SPDX-License-Identifier: Apache-2.0
// Simulated machines for tests: built, loaded and driven, or the test fails.
#pragma once

#include <gtest/gtest.h>

#include "kinfer/simulate/mujoco_world.hpp"

namespace kinfer::test {

inline MujocoWorld world_of(const std::string& name, const MachineOptions& options = {}, std::uint64_t seed = 1) {
  const auto mjcf = machine_mjcf(name, options, Rng(seed));
  EXPECT_TRUE(mjcf) << mjcf.error().what;
  auto world = MujocoWorld::load(*mjcf);
  EXPECT_TRUE(world) << world.error().what;
  return std::move(*world);
}

inline Drive drive_of(const Machine& machine, const ExcitationOptions& options = {}, std::uint64_t seed = 1) {
  auto drive = make_drive(machine, options, Rng(seed));
  EXPECT_TRUE(drive) << drive.error().what;
  return std::move(*drive);
}

inline MachineMotion driven(const MujocoWorld& world, const Drive& drive, double rate = 200.0,
                            Servo servo = Servo::stiff) {
  auto motion = world.drive(drive, rate, servo);
  EXPECT_TRUE(motion) << motion.error().what;
  return std::move(*motion);
}

}  // namespace kinfer::test
