// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/mount_turn.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/random_tracked_tree.hpp"

namespace kinfer::track {
namespace {

double density(const Vec3& x, const MountTurn& belief) {
  const Vec3 d = x - belief.mean;
  return -0.5 * d.dot(belief.covariance.inverse() * d) -
         0.5 * std::log(std::pow(2.0 * std::numbers::pi, 3) * belief.covariance.determinant());
}

/// A belief after a measurement of the turn itself, and ln of the measurement's density by the belief before.
MountTurn updated(const MountTurn& before, const Vec3& measured, const Mat3& noise) {
  const Mat3 gain = before.covariance * (before.covariance + noise).inverse();
  return {before.mean + gain * (measured - before.mean), before.covariance - gain * before.covariance};
}
double log_density(const MountTurn& before, const Vec3& measured, const Mat3& noise) {
  return density(measured, {before.mean, before.covariance + noise});
}

TEST(MountTurn, OddsAreThoseOfTheMeasurementByBothBeliefs) {
  const MountTurn wide{.mean = Vec3(0.01, 0.0, -0.02), .covariance = 0.0025 * Mat3::Identity()};
  const MountTurn narrow{.mean = Vec3(0.001, -0.002, 0.0), .covariance = 1e-6 * Mat3::Identity()};
  Mat3 noise = Vec3(1e-6, 4e-6, 1e-5).asDiagonal();
  noise(0, 1) = noise(1, 0) = 1e-6;
  for (const Vec3& measured : {Vec3(0.0, 0.0, 0.0), Vec3(0.002, -0.001, 0.004), Vec3(0.03, 0.01, -0.02)})
    EXPECT_NEAR(log_odds_of(narrow, wide, updated(wide, measured, noise)),
                log_density(narrow, measured, noise) - log_density(wide, measured, noise), 1e-6);
}

TEST(MountTurn, NothingMeasuredTellsNothing) {
  const MountTurn wide{.mean = Vec3::Zero(), .covariance = 0.0025 * Mat3::Identity()};
  const MountTurn narrow{.mean = Vec3::Zero(), .covariance = 1e-6 * Mat3::Identity()};
  EXPECT_NEAR(log_odds_of(narrow, wide, wide), 0.0, 1e-12);
}

/// Of a sensor whose scale matrices are certain.
TEST(MountTurn, AMountingThatIsCertainHasOdds) {
  Rng rng(5);
  auto model = std::make_shared<FilterModel>(filter_model(test::random_tree(rng)));
  model->parameters.setZero();
  const MountTurn certain = mount_turn(ChainFilter(model), 1);
  const MountTurn wide{.mean = certain.mean, .covariance = 0.0025 * Mat3::Identity()};
  for (const double angle : {0.0, 0.02}) {
    const MountTurn after{.mean = certain.mean + Vec3(angle, 0.0, 0.0), .covariance = 1e-6 * Mat3::Identity()};
    const double odds = log_odds_of(certain, wide, after);
    EXPECT_EQ(odds > 3.0, angle == 0.0) << odds;
    EXPECT_EQ(odds<-3.0, angle> 0.0) << odds;
  }
}

}  // namespace
}  // namespace kinfer::track
