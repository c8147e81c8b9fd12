// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/base_speed.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

constexpr double block = 0.02;  // [s]

/// A base whose velocity has this standard deviation [m/s] per axis, estimated to within `estimate_sd`.
BaseSpeed after_motion(double sd, double estimate_sd, double duration) {
  BaseSpeed speed;
  Rng rng(3);
  for (double t = 0.0; t < duration; t += block) {
    Vec3 velocity;
    for (Eigen::Index k = 0; k < 3; ++k) velocity[k] = sd * rng.normal();
    speed.add(velocity, Vec3::Constant(estimate_sd * estimate_sd), block);
  }
  return speed;
}

TEST(BaseSpeed, IsThatOfTheBase) {
  for (const double sd : {0.03, 0.1, 0.5}) EXPECT_GT(after_motion(sd, 0.01, 60.0).sd(), 0.9 * sd) << sd;
  BaseSpeed speed = after_motion(0.03, 0.01, 60.0);
  speed.add(Vec3::Zero(), Vec3::Zero(), block);  // between two moments in which it is faster than usual
  EXPECT_NEAR(speed.sd(), std::hypot(0.03, 0.01), 0.005);
}

TEST(BaseSpeed, WhatIsUnknownOfTheVelocityCountsAsVelocity) {
  EXPECT_NEAR(after_motion(0.0, 0.2, 60.0).sd(), 0.2, 0.01);
}

TEST(BaseSpeed, ABaseThatBeginsToDriveIsBelievedAtOnce) {
  BaseSpeed speed = after_motion(0.0, 0.01, 60.0);
  EXPECT_NEAR(speed.sd(), least_base_speed, 1e-3);
  speed.add(Vec3(1.0, 0.0, 0.0), Vec3::Constant(1e-4), block);
  EXPECT_NEAR(speed.sd(), 1.0 / std::sqrt(3.0), 1e-6);
}

}  // namespace
}  // namespace kinfer::track
