// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/joint_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/motion/line_profile.hpp"

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

TEST(LineProfile, CoversItsLengthAndCannotBeBeatenByASlowerPeak) {
  Rng rng(3);
  for (int i = 0; i < 300; ++i) {
    const MotionLimits limits = random_limits(rng);
    const double first = rng.uniform() * limits.velocity, last = i % 3 == 0 ? 0.0 : rng.uniform() * limits.velocity;
    const double length = std::exp(rng.uniform(-6.0, 2.0));
    const auto ramp = [&](double change) { return fastest_ramp(change, limits).duration(); };
    const LineProfile profile = quickest_profile(length, first, last, limits);
    if (!std::isfinite(profile.duration)) {
      EXPECT_GT(0.5 * (first + last) * ramp(last - first), length);
      continue;
    }
    EXPECT_GE(profile.peak, std::max(first, last));
    EXPECT_LE(profile.peak, limits.velocity);
    const double ramps =
        0.5 * ((first + profile.peak) * ramp(profile.peak - first) + (profile.peak + last) * ramp(profile.peak - last));
    EXPECT_NEAR(ramps + profile.cruise * profile.peak, length, 1e-14 * length);
    if (profile.peak < limits.velocity) EXPECT_LT(profile.cruise, 1e-12 * profile.duration) << "a higher peak fits";
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
                                   .most_cut = 0.2 * std::pow(0.1, static_cast<double>(seed % 4))};
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

struct RandomPath {
  MatrixXd waypoints;
  std::vector<MotionLimits> limits;
  double duration(const JointPathOptions& options) const { return JointPath(waypoints, limits, options).duration(); }
};

/// Long lines that reach their speeds, and short ones that do not.
RandomPath random_path(std::uint64_t seed) {
  Rng rng = Rng(7).stream(seed);
  RandomPath path{MatrixXd(1 + static_cast<Index>(seed % 6), 3 + static_cast<Index>(seed % 4)), {}};
  const double size = std::array{2.0, 0.5, 0.1}[seed % 3];
  for (double& q : path.waypoints.reshaped()) q = rng.uniform(-size, size);
  for (Index k = 0; k < path.waypoints.rows(); ++k) path.limits.push_back(random_limits(rng));
  return path;
}

TEST(JointPath, ALargerCornerIsNeverSlowerAndNoneIsSlowerThanStopping) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const RandomPath path = random_path(seed);
    double before = path.duration({.stop_at_waypoints = true});
    for (const double corner : {0.0, 1e-12, 1e-8, 1e-5, 1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.05, 0.06, 0.1, 0.3, 2.0}) {
      const double duration = path.duration({.most_cut = corner});
      EXPECT_LE(duration, before * (1.0 + 1e-13)) << "path " << seed << ", corner " << corner;
      before = duration;
    }
  }
}

TEST(JointPath, ACornerOfNothingIsAStop) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const RandomPath path = random_path(seed);
    const JointPath none(path.waypoints, path.limits, {.most_cut = 0.0});
    EXPECT_EQ(none.duration(), path.duration({.stop_at_waypoints = true}));
    for (std::size_t w = 0; w < none.passing_times().size(); ++w) {
      const PathState state = none.at(none.passing_times()[w]);
      EXPECT_LT((state.position - path.waypoints.col(static_cast<Index>(w))).norm(), 1e-12);
      EXPECT_LT(state.velocity.norm(), 1e-7);
    }
  }
}

TEST(JointPath, ACornerIsCutInTheUnitOfEachJoint) {
  int quicker = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const RandomPath path = random_path(seed);
    VectorXd units(path.waypoints.rows());
    for (Index k = 0; k < units.size(); ++k) units[k] = k % 2 == 0 ? 0.02 : 0.001;
    const JointPath cut(path.waypoints, path.limits, {.most_cut = 3.0, .cut_units = units});
    quicker += cut.duration() < path.duration({.stop_at_waypoints = true});
    for (std::size_t w = 0; w < cut.cuts().size(); ++w) {
      const VectorXd missed = cut.at(cut.passing_times()[w]).position - path.waypoints.col(static_cast<Index>(w));
      EXPECT_NEAR(missed.cwiseQuotient(units).cwiseAbs().maxCoeff(), cut.cuts()[w], 1e-6);
      EXPECT_LE(cut.cuts()[w], 3.0 * (1.0 + 1e-9));
    }
  }
  EXPECT_GE(quicker, 6);  // else a stop is
}

TEST(JointPath, OnlyNearACornerIsItSlower) {
  // A right angle between lines that take 10 s each at full speed: all but the ends and the corner is at full speed.
  const MatrixXd waypoints = (MatrixXd(2, 3) << 0.0, 10.0, 10.0, 0.0, 0.0, 10.0).finished();
  const std::vector<MotionLimits> limits(2, {1.0, 4.0, 40.0});
  for (const double corner : {0.005, 0.01, 0.03}) {
    const JointPath path(waypoints, limits, {.most_cut = corner});
    EXPECT_GT(path.cuts()[1], 0.8 * corner);
    EXPECT_NEAR(path.at(9.0).velocity[0], 1.0, 1e-12);
    EXPECT_NEAR(path.at(path.passing_times()[1] - 1.0).velocity[0], 1.0, 1e-12);
    EXPECT_NEAR(path.at(path.passing_times()[1] + 1.0).velocity[1], 1.0, 1e-12);
    EXPECT_LT(path.duration(), 20.0 + 3.0 * 0.35);  // a ramp from rest takes 0.35 s and loses half of it
  }
}

TEST(JointPath, VelocityAndPositionAreContinuous) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const RandomPath random = random_path(seed);
    const JointPath path(random.waypoints, random.limits, {.most_cut = 0.03});
    constexpr int samples = 20000;
    const double h = path.duration() / samples;
    PathState before = path.at(0.0);
    for (int i = 1; i <= samples; ++i) {
      const PathState state = path.at(i * h);
      for (Index k = 0; k < state.position.size(); ++k) {
        const MotionLimits& limit = random.limits[static_cast<std::size_t>(k)];
        // Jerk jumps and is limited: no change exceeds what it explains.
        EXPECT_LE(std::abs(state.acceleration[k] - before.acceleration[k]), limit.jerk * h + 1e-10);
        EXPECT_LE(std::abs(state.velocity[k] - before.velocity[k] - h * before.acceleration[k]),
                  0.5 * limit.jerk * h * h + 1e-12);
        EXPECT_LE(std::abs(state.position[k] - before.position[k] - h * before.velocity[k] -
                           0.5 * h * h * before.acceleration[k]),
                  limit.jerk * h * h * h / 6.0 + 1e-12);
      }
      before = state;
    }
  }
}

TEST(JointPath, ChangesOfVelocityOfAnySizeKeepTheLimits) {
  // A corner just below the speed of its line: the ramp is a millionth of the velocities at its ends.
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Rng rng = Rng(99).stream(seed);
    MatrixXd waypoints(1 + static_cast<Index>(seed % 6), 2 + static_cast<Index>(seed % 7));
    std::vector<MotionLimits> limits;
    for (Index k = 0; k < waypoints.rows(); ++k) {
      const double velocity = std::exp(rng.uniform(-4.0, 4.0)), acceleration = std::exp(rng.uniform(-4.0, 5.0));
      limits.push_back({velocity, acceleration, std::exp(rng.uniform(-4.0, 8.0))});
    }
    const double size = std::exp(rng.uniform(-6.0, 2.0));
    for (double& q : waypoints.reshaped()) q = rng.uniform(-size, size);
    for (const double corner : {0.05, 1.0}) {
      const JointPath path(waypoints, limits, {.most_cut = corner});
      double largest = 0.0;  // of all parts of their limits
      for (int i = 0; i <= 2000; ++i) {
        const PathState state = path.at(path.duration() * i / 2000);
        for (Index k = 0; k < waypoints.rows(); ++k) {
          const MotionLimits& limit = limits[static_cast<std::size_t>(k)];
          largest =
              std::max({largest, std::abs(state.velocity[k]) / limit.velocity,
                        std::abs(state.acceleration[k]) / limit.acceleration, std::abs(state.jerk[k]) / limit.jerk});
        }
      }
      EXPECT_LE(largest, 1.0 + 1e-12) << "path " << seed;
    }
  }
}

TEST(JointPath, AWaypointBesideItsNeighbourDoesNotSlowDown) {
  const std::vector<MotionLimits> limits(2, {1.0, 4.0, 40.0});
  const MatrixXd two = (MatrixXd(2, 3) << 0.0, 0.5, 0.0, 0.0, 0.2, 0.6).finished();
  for (const double apart : {1e-14, 1e-12, 1e-9, 1e-6, 1e-300}) {
    MatrixXd waypoints(2, 4);
    waypoints << two.leftCols(2), two.rightCols(2);
    waypoints(1, 2) += apart;
    const double stopping = JointPath(waypoints, limits, {.stop_at_waypoints = true}).duration();
    for (const double corner : {0.0, 1e-6, 0.05})
      EXPECT_LE(JointPath(waypoints, limits, {.most_cut = corner}).duration(), stopping * (1.0 + 1e-13));
  }
}

TEST(JointPath, APathThatDoesNotMoveTakesNoTime) {
  const JointPath path(MatrixXd::Ones(2, 3), std::vector<MotionLimits>(2, {1.0, 1.0, 1.0}));
  EXPECT_EQ(path.duration(), 0.0);
  EXPECT_EQ(path.at(0.0).position, VectorXd::Ones(2));
}

}  // namespace
}  // namespace kinfer::motion
