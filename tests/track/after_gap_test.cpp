// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/after_gap.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinfer::track {
namespace {

constexpr LastPosition slow{
    .time = 10.0, .value = 0.5, .rate = 0.2, .sd = 0.003, .most_turned = 0.8, .speed = 0.4, .acceleration_sd = 1.6};

TEST(AfterGap, IsExactForAConstantAcceleration) {
  constexpr double gap = 0.5, acceleration = -0.3;
  EXPECT_NEAR(after_gap(slow, 10.0 + gap, 0.2 + acceleration * gap).value,
              0.5 + 0.2 * gap + 0.5 * acceleration * gap * gap, 1e-15);
}

TEST(AfterGap, IsAsUncertainAsAccelerationsLeaveItAndAsTheJointCanTurn) {
  EXPECT_NEAR(after_gap(slow, 10.5, 0.2).sd, std::hypot(0.003, 1.6 * 0.25 / 8.0), 1e-15);
  EXPECT_NEAR(after_gap(slow, 12.0, 0.2).sd, std::hypot(0.003, 0.8), 1e-15) << "2 s at its speed";
  EXPECT_NEAR(after_gap(slow, 100.0, 0.2).sd, std::hypot(0.003, 0.8), 1e-15) << "half of its range";
}

}  // namespace
}  // namespace kinfer::track
