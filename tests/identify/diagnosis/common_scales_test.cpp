// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/common_scales.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/constants.hpp"
#include "kinfer/base/rng.hpp"

namespace kinfer::identify {
namespace {

/// What sensors with errors of their own read of gravity.
std::vector<double> readings(std::size_t sensors, double gravity, double sd, std::uint64_t seed = 1) {
  Rng rng(seed);
  std::vector<double> all;
  for (std::size_t s = 0; s < sensors; ++s) all.push_back(gravity + sd * rng.normal());
  return all;
}

TEST(CommonForceScale, GravityOfAnyPlaceIsNoScaleError) {
  for (const double place : {least_gravity, standard_gravity, largest_gravity})
    for (const double sd : {0.003, 0.03, 0.2})
      for (std::uint64_t seed = 1; seed <= 20; ++seed)
        EXPECT_LT(common_force_scale(readings(6, place, sd, seed)).log_odds, 0.0) << place << ' ' << sd << ' ' << seed;
}

TEST(CommonForceScale, MoreThanGravityHasAnywhereIsOne) {
  for (const double factor : {0.9, 0.985, 1.01, 10.0 / standard_gravity, 1.2})
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const ForceScale scale = common_force_scale(readings(6, factor * standard_gravity, 0.01, seed));
      EXPECT_GT(scale.log_odds, 0.0) << factor;
      EXPECT_NEAR(scale.factor, factor, 3.0 * scale.sd);
      EXPECT_NEAR(scale.sd, usual_gravity_sd / usual_gravity, 1e-3);
    }
}

TEST(CommonForceScale, OneSensorAndSensorsThatDisagreeSayLittle) {
  EXPECT_LT(common_force_scale(readings(1, 1.01 * standard_gravity, 0.01)).log_odds, 0.0);
  EXPECT_LT(common_force_scale(std::vector<double>{9.8, 9.81, 9.79, 11.0}).log_odds, 0.0);
  EXPECT_GT(common_force_scale(std::vector<double>{9.6, 10.1, 9.9, 10.3}).sd, 0.01);
}

}  // namespace
}  // namespace kinfer::identify
