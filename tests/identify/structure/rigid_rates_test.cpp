// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/rigid_rates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/random.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer {
using namespace identify;
namespace rigid_rates_test {
namespace {

constexpr double period = 0.01, noise = 1e-3;  // [s], [rad/s] of a sample
constexpr std::size_t samples = 4000;

/// Two gyroscopes with scale errors; the second one rotates by `hinge` [rad] (amplitude at 0.3 Hz) about its x axis.
RecordedMotion two_gyroscopes(double hinge) {
  Rng rng(1);
  Mat3 child_R_parent = exp_so3({0.4, -0.7, 1.1});
  child_R_parent(0, 1) += 0.004;
  child_R_parent(2, 2) *= 1.005;
  RecordedMotion motion;
  motion.period = period;
  motion.segments.resize(2);
  motion.usable.assign(samples, true);
  for (std::size_t row = 0; row < samples; ++row) {
    const double t = period * static_cast<double>(row), w = 2.0 * 3.14159 * 0.3;
    const Vec3 rate(std::sin(1.3 * t), 0.8 * std::cos(0.9 * t + 1.0), 0.7 * std::sin(2.1 * t + 0.3));
    const Vec3 of_parent = noise * normal_vector(rng), of_child = noise * normal_vector(rng);
    motion.time.push_back(t);
    motion.segments[0].gyro.push_back(rate + of_parent);
    motion.segments[1].gyro.push_back(child_R_parent * rate + Vec3(0.01 + hinge * w * std::cos(w * t), 0.0, 0.0) +
                                      of_child);
  }
  return motion;
}

RigidRates rates_of(double hinge) {
  const RecordedMotion motion = two_gyroscopes(hinge);
  return rigid_rates(motion, motion.segments[0], motion.segments[1]);
}

TEST(RigidRates, ScalesAndBiasesLeaveNothingButNoise) {
  const RigidRates rates = rates_of(0.0);
  EXPECT_NEAR(rates.noise, noise * std::sqrt(2.0 / 10.0), 1e-4);  // of two gyroscopes, ten samples a mean
  EXPECT_NEAR(rates.residual / rates.noise, 1.0, 0.15);
  EXPECT_GT(rates.level, 1.0);
}

TEST(RigidRates, AHingeOfATenthOfADegreeStandsAboveTheNoise) {
  const RigidRates rates = rates_of(1.75e-3);
  EXPECT_NEAR(rates.residual, 1.75e-3 * 2.0 * 3.14159 * 0.3 / std::sqrt(2.0), 5e-4);
  EXPECT_GT(rates.residual, 4.0 * rates.noise);
}

}  // namespace
}  // namespace rigid_rates_test
}  // namespace kinfer
