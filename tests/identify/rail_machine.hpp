// SPDX-License-Identifier: Apache-2.0
// A machine on a rail: a base at rest, a carriage that slides on it without ever rotating, and an arm on the carriage.
#pragma once

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::test {

/// From one position to the next, each move of one second with the least jerk (Flash and Hogan 1985): position,
/// velocity and acceleration.
inline std::array<double, 3> point_to_point(std::span<const double> positions, double begin, double t) {
  const double since = t - begin;
  if (since <= 0.0) return {positions.front(), 0.0, 0.0};
  const auto move = std::min(static_cast<std::size_t>(since), positions.size() - 2);
  const double x = std::min(1.0, since - static_cast<double>(move)), stroke = positions[move + 1] - positions[move];
  return {positions[move] + stroke * x * x * x * (10.0 - 15.0 * x + 6.0 * x * x),
          stroke * 30.0 * x * x * (1.0 - x) * (1.0 - x), stroke * 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x)};
}

struct RailMachine {
  InsBodies bodies{{.sensor = 0},
                   prismatic_body(0, 1, exp_so3(Vec3(0.4, 1.1, -0.3)), exp_so3(Vec3(-0.9, 0.3, 0.7))),
                   revolute_body(1, 2, exp_so3(Vec3(1.2, 0.1, -0.3)), exp_so3(Vec3(-0.1, 0.8, 0.2)))};
  InsRecording recording;

  /// `travel` [m]: largest distance of the carriage from the middle of the rail.
  RailMachine(double travel, std::uint64_t seed) {
    constexpr double length = 40.0, period = 0.01;  // [s]
    bodies[1].point_in_parent = Vec3(0.3, 0.2, 0.1);
    bodies[2].point_in_parent = Vec3(0.2, -0.3, 0.4);
    bodies[2].point_in_child = Vec3(-0.18, 0.25, 0.1);
    recording.loggers = {{.name = "log", .time = {}}};
    for (const char* name : {"base", "carriage", "arm"})
      recording.sensors.push_back(
          {.name = name, .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}});
    Rng rng(seed);
    std::array<SensorErrors, 3> errors{draw_errors(rng), draw_errors(rng), draw_errors(rng)};
    std::vector<double> slide{0.0}, turn{0.0};
    for (int move = 0; move < 32; ++move) {
      slide.push_back(rng.uniform(-travel, travel));
      turn.push_back(rng.uniform(-0.8, 0.8));
    }
    for (double t = 0.0; t < length; t += period) {
      recording.loggers[0].time.push_back(t);
      InsState base;
      base.force = exp_so3(Vec3(0.3, -0.2, 0.0)) * Vec3(0.0, 0.0, 9.81);
      const auto q = point_to_point(slide, 4.0, t), p = point_to_point(turn, 4.4, t);
      const InsState carriage = propagated(bodies[1], {Vec3(q[0], 0, 0), Vec3(q[1], 0, 0), Vec3(q[2], 0, 0)}, base);
      const InsState arm = propagated(bodies[2], {Vec3(p[0], 0, 0), Vec3(p[1], 0, 0), Vec3(p[2], 0, 0)}, carriage);
      put(recording.sensors[0], errors[0], base, rng);
      put(recording.sensors[1], errors[1], carriage, rng);
      put(recording.sensors[2], errors[2], arm, rng);
    }
  }

 private:
  /// Constant errors of an industrial sensor, and the wandering bias of its gyroscope.
  struct SensorErrors {
    Mat3 rate_scale = Mat3::Identity(), force_scale = Mat3::Identity();
    Vec3 rate_bias = Vec3::Zero(), force_bias = Vec3::Zero();
  };

  static Vec3 normal(Rng& rng, double sd) {
    Vec3 draw;
    for (double& value : draw) value = sd * rng.normal();
    return draw;
  }

  static SensorErrors draw_errors(Rng& rng) {
    SensorErrors errors{.rate_bias = normal(rng, 3.5e-3), .force_bias = normal(rng, 0.01)};
    for (Eigen::Index k = 0; k < 3; ++k) {
      errors.rate_scale.col(k) += normal(rng, 5e-4);
      errors.force_scale.col(k) += normal(rng, 3e-4);
    }
    return errors;
  }

  static void put(InsSensor& sensor, SensorErrors& errors, const InsState& state, Rng& rng) {
    constexpr double rate_noise = 9e-4, force_noise = 7.6e-3, bias_walk = 7e-7;  // [rad/s], [m/s²], [rad/s] a row
    errors.rate_bias += normal(rng, bias_walk);
    const Vec3 rate = errors.rate_scale * state.angular_velocity + errors.rate_bias + normal(rng, rate_noise),
               force = errors.force_scale * state.force + errors.force_bias + normal(rng, force_noise);
    for (std::size_t k = 0; k < 3; ++k) {
      sensor.angular_velocity.axis[k].push_back(static_cast<float>(rate[static_cast<Eigen::Index>(k)]));
      sensor.acceleration.axis[k].push_back(static_cast<float>(force[static_cast<Eigen::Index>(k)]));
    }
    sensor.faults.push_back(0);
  }
};

}  // namespace kinfer::test
