// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/joint_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"

namespace kinfer::motion {
namespace {

using Eigen::Index;

MotionLimits random_limits(Rng& rng) {
  const double velocity = rng.uniform(0.2, 3.0), acceleration = rng.uniform(0.5, 10.0), jerk = rng.uniform(2.0, 80.0);
  return {velocity, acceleration, jerk};
}

/// Shortest time from rest to rest by the four cases of Biagiotti and Melchiorri 2008, section 3.4.
double double_s_time(double distance, const MotionLimits& m) {
  double ramp = m.velocity * m.jerk < m.acceleration * m.acceleration
                    ? 2.0 * std::sqrt(m.velocity / m.jerk)
                    : m.acceleration / m.jerk + m.velocity / m.acceleration;
  if (distance >= m.velocity * ramp) return distance / m.velocity + ramp;
  if (distance >= 2.0 * std::pow(m.acceleration, 3) / (m.jerk * m.jerk)) {
    const double half = 0.5 * m.acceleration / m.jerk;
    return 2.0 * (half + std::sqrt(half * half + distance / m.acceleration));
  }
  return 4.0 * std::cbrt(0.5 * distance / m.jerk);
}

TEST(SRamp, ChangesTheSpeedByOneWithinItsLimits) {
  for (const auto& [acceleration, jerk] : {std::pair{2.0, 3.0}, std::pair{1.0, 5.0}, std::pair{1.0, 1.0}}) {
    const SRamp ramp(acceleration, jerk);
    EXPECT_EQ(ramp.at(0.0).speed, 0.0);
    EXPECT_EQ(ramp.at(ramp.duration()).speed, 1.0);
    EXPECT_NEAR(ramp.at(ramp.duration()).position, 0.5, 1e-15);
    constexpr double h = 1e-5;
    for (double t = h; t < ramp.duration() - h; t += 0.01) {
      const RampState s = ramp.at(t), before = ramp.at(t - h), after = ramp.at(t + h);
      EXPECT_NEAR((after.position - before.position) * ramp.duration() / (2.0 * h), s.speed, 1e-8);
      EXPECT_NEAR((after.speed - before.speed) / (2.0 * h), s.acceleration, 1e-4);
      EXPECT_LE(s.acceleration, acceleration * (1.0 + 1e-14));
      EXPECT_LE(std::abs(s.jerk), jerk);
    }
  }
}

TEST(JointPath, OneLineIsTheTimeOptimalDoubleS) {
  Rng rng(1);
  for (int i = 0; i < 300; ++i) {
    const MotionLimits limits = random_limits(rng);
    const double distance = std::exp(rng.uniform(-9.0, 3.0));
    const JointPath path((MatrixXd(1, 2) << 0.5, 0.5 + distance).finished(), {limits});
    EXPECT_NEAR(path.duration(), double_s_time(distance, limits), 1e-9 * path.duration());
  }
}

/// Waypoints, some of which turn back or repeat.
MatrixXd random_waypoints(Rng& rng, Index joints, Index count) {
  MatrixXd waypoints(joints, count);
  for (double& q : waypoints.reshaped()) q = rng.uniform(-2.0, 2.0);
  if (count > 3) waypoints.col(2) = waypoints.col(1);
  return waypoints;
}

TEST(JointPath, LimitsAreKeptAndEndsAreMet) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Rng rng = Rng(2).stream(seed);
    const Index joints = 1 + static_cast<Index>(seed % 6), count = 2 + static_cast<Index>(seed % 5);
    std::vector<MotionLimits> limits;
    for (Index k = 0; k < joints; ++k) limits.push_back(random_limits(rng));
    const MatrixXd waypoints = random_waypoints(rng, joints, count);
    const JointPathOptions options{.stop_at_waypoints = seed % 3 == 0,
                                   .most_cut = 0.02 * static_cast<double>(1 + seed % 4)};
    const JointPath path(waypoints, limits, options);
    EXPECT_EQ(path.at(0.0).position, waypoints.col(0));
    EXPECT_EQ(path.at(path.duration()).position, waypoints.col(count - 1));
    EXPECT_LT((path.at(path.duration() * (1.0 - 1e-9)).position - waypoints.col(count - 1)).norm(), 1e-7);
    constexpr int samples = 3000;
    VectorXd before = waypoints.col(0);
    for (int i = 0; i <= samples; ++i) {
      const PathState state = path.at(path.duration() * i / samples);
      for (Index k = 0; k < joints; ++k) {
        const MotionLimits& limit = limits[static_cast<std::size_t>(k)];
        EXPECT_LE(std::abs(state.velocity[k]), limit.velocity * (1.0 + 1e-12));
        EXPECT_LE(std::abs(state.acceleration[k]), limit.acceleration * (1.0 + 1e-12));
        EXPECT_LE(std::abs(state.jerk[k]), limit.jerk * (1.0 + 1e-12));
        EXPECT_LE(std::abs(state.position[k] - before[k]),
                  limit.velocity * path.duration() / samples * (1.0 + 1e-9) + 1e-12);
      }
      before = state.position;
    }
    ASSERT_EQ(path.passing_times().size(), static_cast<std::size_t>(count));
    for (Index w = 0; w < count; ++w) {
      const VectorXd passed = path.at(path.passing_times()[static_cast<std::size_t>(w)]).position;
      const double missed = (passed - waypoints.col(w)).cwiseAbs().maxCoeff();
      EXPECT_NEAR(missed, path.cuts()[static_cast<std::size_t>(w)], 1e-9);
      EXPECT_LE(missed, options.stop_at_waypoints ? 1e-9 : options.most_cut * (1.0 + 1e-9));
    }
  }
}

TEST(JointPath, CuttingCornersTakesLessTimeThanStopping) {
  Rng rng(5);
  const MatrixXd waypoints = random_waypoints(rng, 6, 3);
  const std::vector<MotionLimits> limits(6, {1.5, 6.0, 60.0});
  const double stopping = JointPath(waypoints, limits, {.stop_at_waypoints = true}).duration();
  const double little = JointPath(waypoints, limits, {.most_cut = 0.01}).duration();
  const double much = JointPath(waypoints, limits, {.most_cut = 0.2}).duration();
  EXPECT_LT(much, little);
  EXPECT_LT(much, stopping);
}

TEST(JointPath, APathThatDoesNotMoveTakesNoTime) {
  const JointPath path(MatrixXd::Ones(2, 3), std::vector<MotionLimits>(2, {1.0, 1.0, 1.0}));
  EXPECT_EQ(path.duration(), 0.0);
  EXPECT_EQ(path.at(0.0).position, VectorXd::Ones(2));
}

}  // namespace
}  // namespace kinfer::motion
