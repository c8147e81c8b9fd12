// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/batch_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/model/uniform_spline.hpp"
#include "kinfer/geometry/random.hpp"

namespace kinfer {
namespace {

using Eigen::Index;

/// amplitude sin(2π frequency t + phase), its first and its second derivative.
Vec3 wave(double amplitude, double frequency, double phase, double t) {
  const double w = 2.0 * std::numbers::pi * frequency, at = w * t + phase;
  return amplitude * Vec3(std::sin(at), w * std::cos(at), -w * w * std::sin(at));
}

/// A level root that is carried along a circle of 5 cm, and a second INS on a vertical hinge: only the root's slow
/// acceleration tells by which angle the second one is turned against the first.
struct LevelHinge {
  static constexpr double rate_noise = 1e-3, force_noise = 0.02;   // [rad/s], [m/s²]
  static constexpr double radius = 0.05, circle_frequency = 0.25;  // [m], [Hz] of the root's motion
  static constexpr double period = 0.01;                           // [s]
  static constexpr int rows = 2000;

  InsProblem problem;
  InsUnknowns truth;

  explicit LevelHinge(std::uint64_t seed) {
    problem.grid = {0.0, 0.1, 200};
    problem.root_at_rest = false;
    problem.prior = {.gyroscope_bias = 1e-2, .accelerometer_bias = 0.1};
    problem.anchor = {0.0};
    truth.bodies = {{.sensor = 0}, revolute_body(0, 1, Mat3::Identity(), Mat3::Identity())};
    truth.bodies[1].point_in_parent = Vec3(0.25, 0.02, -0.03);
    truth.bodies[1].point_in_child = Vec3(-0.15, 0.04, 0.02);
    truth.errors.resize(2);
    measure(Rng(seed));
  }

  void measure(Rng rng) {
    std::vector<InsSensor> sensors(2);
    std::vector<double> time;
    MatrixXd trajectory(rows, 7);  // of the root's angular velocity and specific force, and the joint's position
    for (int row = 0; row < rows; ++row) {
      time.push_back(period * row);
      const Vec3 yaw = wave(0.3, 0.15, 0.3, time.back()), roll = wave(0.005, 0.21, 1.1, time.back()),
                 joint = wave(0.5, 0.12, 2.0, time.back()), east = wave(radius, circle_frequency, 0.7, time.back()),
                 north = wave(radius, circle_frequency, 2.3, time.back());
      InsState root;
      root.angular_velocity = Vec3(roll[1], 0.0, yaw[1]);
      root.angular_acceleration = Vec3(roll[2], 0.0, yaw[2]);
      root.force = Vec3(east[2], north[2], standard_gravity);
      JointKinematicState q;
      for (std::size_t order = 0; order < 3; ++order) q[order] = Vec3(joint[static_cast<Index>(order)], 0.0, 0.0);
      trajectory.row(row) << root.angular_velocity.transpose(), root.force.transpose(), joint[0];
      put(sensors[0], root, rng);
      put(sensors[1], propagated(truth.bodies[1], q, root), rng);
    }
    truth.spline_coefficients = fit_spline(problem.grid, time, trajectory);
    const InsNoise noise{.angular_velocity = rate_noise, .force = force_noise};
    for (const InsSensor& sensor : sensors)
      problem.sensors.push_back({ins_blocks(sensor, time, InsInstrument::gyroscope, problem.grid),
                                 ins_blocks(sensor, time, InsInstrument::accelerometer, problem.grid), noise, noise});
  }

  static void put(InsSensor& sensor, const InsState& state, Rng& rng) {
    const Vec3 rate = state.angular_velocity + rate_noise * normal_vector(rng),
               force = state.force + force_noise * normal_vector(rng);
    for (std::size_t k = 0; k < 3; ++k) {
      sensor.angular_velocity.axis[k].push_back(static_cast<float>(rate[static_cast<Index>(k)]));
      sensor.acceleration.axis[k].push_back(static_cast<float>(force[static_cast<Index>(k)]));
    }
    sensor.faults.push_back(0);
  }

  InsUnknowns start_from(double angle) const {
    InsUnknowns start = truth;
    start.spline_coefficients.row(6).array() += angle;
    start.bodies[1].point_in_parent.setZero(), start.bodies[1].point_in_child.setZero();
    return start;
  }
};

TEST(BatchFit, AWeakAzimuthIsFoundFromFarAwayOnTheCircle) {
  constexpr double w = 2.0 * std::numbers::pi * LevelHinge::circle_frequency,
                   acceleration = LevelHinge::radius * w * w;  // [m/s²]
  const double sd =
      std::numbers::sqrt2 * LevelHinge::force_noise / (acceleration * std::sqrt(LevelHinge::rows));  // [rad], 5e-3
  for (const std::uint64_t seed : {1u, 2u, 3u})
    for (const double angle : {1.5, -1.5, 3.0}) {
      LevelHinge hinge(seed);
      const InsFit fit = fit_ins(hinge.problem, hinge.start_from(angle), {.threads = 1});
      const double error = (fit.unknowns.spline_coefficients - hinge.truth.spline_coefficients).row(6).mean();
      EXPECT_LT(std::abs(std::remainder(error, 2.0 * std::numbers::pi)), 5.0 * sd) << angle;
      EXPECT_EQ(fit.stop, Stop::converged_cost);
    }
}

}  // namespace
}  // namespace kinfer
