// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/excerpt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/rng.hpp"

namespace kinfer {
namespace {

using Eigen::Index;

constexpr double rate_noise = 1e-3, force_noise = 1e-2;

/// Angle [rad] of a revolute joint that moves in the second and the last quarter only.
double joint_angle(double time, double length) {
  const double quarter = 0.25 * length, waves = 4.0 * std::round(length / 25.6);  // at rest between quarters
  const bool moves = (time > quarter && time < 2.0 * quarter) || time > 3.0 * quarter;
  return moves ? 0.4 * std::pow(std::sin(2.0 * std::numbers::pi * waves * time / length), 3) : 0.0;
}

/// Two INS on a revolute joint about the horizontal x axis of a stationary root, the second 0.5 m from the axis.
InsProblem swinging(Index intervals) {
  InsProblem problem;
  problem.grid = {0.0, 0.1, intervals};
  problem.prior = {.gyroscope_bias = 1e-3, .accelerometer_bias = 1e-2};
  Rng rng(4);
  std::array<InsSensor, 2> sensors{
      InsSensor{.name = "a", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}},
      InsSensor{.name = "b", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}}};
  std::vector<double> time;
  const double length = problem.grid.end(), h = 1e-3;
  for (double t = 0.0; t < length; t += 0.025) {
    time.push_back(t);
    const double q = joint_angle(t, length),
                 angular_velocity = (joint_angle(t + h, length) - joint_angle(t - h, length)) / (2.0 * h),
                 angular_acceleration = (joint_angle(t + h, length) - 2.0 * q + joint_angle(t - h, length)) / (h * h);
    const Vec3 arm(0.0, 0.5, 0.0), omega(angular_velocity, 0.0, 0.0);
    const std::array<Vec3, 2> angular_velocities{Vec3::Zero(), omega};
    const std::array<Vec3, 2> forces{Vec3(0.0, 0.0, 9.80665), rot_x(-q) * Vec3(0.0, 0.0, 9.80665) +
                                                                  Vec3(angular_acceleration, 0.0, 0.0).cross(arm) +
                                                                  omega.cross(omega.cross(arm))};
    for (std::size_t s = 0; s < 2; ++s) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Index>(k);
        sensors[s].angular_velocity.axis[k].push_back(
            static_cast<float>(angular_velocities[s][axis] + rate_noise * rng.normal()));
        sensors[s].acceleration.axis[k].push_back(static_cast<float>(forces[s][axis] + force_noise * rng.normal()));
      }
      sensors[s].faults.push_back(0);
    }
  }
  for (const InsSensor& sensor : sensors) {
    const InsNoise noise{.angular_velocity = rate_noise, .force = force_noise};
    problem.sensors.push_back({ins_blocks(sensor, time, InsInstrument::gyroscope, problem.grid),
                               ins_blocks(sensor, time, InsInstrument::accelerometer, problem.grid), noise, noise});
  }
  return problem;
}

InsUnknowns guess(const InsProblem& problem) {
  InsUnknowns x;
  const Mat3 about_x = rot_y(1.5707963);  // its third column is x
  x.bodies = {{.sensor = 0}, revolute_body(0, 1, about_x, about_x)};
  x.bodies[1].point_in_child = Vec3(0.0, -0.3, 0.0);
  x.root_force = Vec3(0.0, 0.0, 9.8);
  x.errors.resize(2);
  x.spline_coefficients = MatrixXd::Zero(1, problem.grid.coefficients());
  return x;
}

TEST(Excerpt, TakesWindowsInWhichTheJointRotates) {
  const InsProblem problem = swinging(2560);  // windows 0..39
  const auto windows = most_informative_windows(problem, guess(problem).bodies, 12);
  ASSERT_EQ(windows.size(), 12U);
  EXPECT_TRUE(std::ranges::is_sorted(windows));
  for (const Index window : windows) EXPECT_TRUE((window >= 10 && window < 20) || window >= 30) << window;
}

TEST(Excerpt, AllWindowsAreTakenWhereFewerExistThanRequested) {
  const InsProblem problem = swinging(200);
  const auto windows = most_informative_windows(problem, guess(problem).bodies, 12);
  EXPECT_EQ(windows, (std::vector<Index>{0, 1, 2}));
}

TEST(Excerpt, FindsTheGeometryFromWindowsThatLieFarApart) {
  const InsProblem problem = swinging(2560);
  const InsExcerpt excerpt = excerpt_of(problem, guess(problem), {11, 16, 31, 38});
  EXPECT_EQ(excerpt.problem.grid.intervals, 4 * excerpt_window);
  InsProblem part = excerpt.problem;
  const InsFit fit = fit_ins(part, excerpt.start, {.threads = 1});
  const Vec3 point = fit.unknowns.bodies[1].point_in_child;
  EXPECT_NEAR(point.y(), -0.5, 5e-3);
  EXPECT_NEAR(point.z(), 0.0, 5e-3);
}

TEST(Excerpt, AShortRecordingIsFittedAsAWhole) {
  InsProblem problem = swinging(2560);
  InsUnknowns start = guess(problem);
  EXPECT_FALSE(start_from_excerpt(problem, start, {.threads = 1}));
  EXPECT_EQ(start.bodies[1].point_in_child, guess(problem).bodies[1].point_in_child);
}

TEST(Excerpt, ALongRecordingStartsFromItsExcerptsFitForAnyNumberOfThreads) {
  const InsProblem problem = swinging(12400);
  Vec3 first = Vec3::Zero();
  for (const int threads : {1, 2, 7}) {
    InsProblem own = problem;
    InsUnknowns start = guess(problem);
    ASSERT_TRUE(start_from_excerpt(own, start, {.threads = threads}));
    EXPECT_NEAR(start.bodies[1].point_in_child.y(), -0.5, 3e-3);
    if (threads == 1) first = start.bodies[1].point_in_child;
    EXPECT_EQ(start.bodies[1].point_in_child, first);
  }
}

}  // namespace
}  // namespace kinfer
