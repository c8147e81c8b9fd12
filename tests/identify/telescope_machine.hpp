// SPDX-License-Identifier: Apache-2.0
// An arm with a telescope: a base at rest, a carriage that slews, a boom that is luffed, a telescope in the boom, and a
// jib. Each joint is driven by itself, then all together, so that the telescope slides while the boom rotates.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::test {

struct TelescopeMachine {
  InsBodies bodies;
  InsRecording recording;

  /// `travel` [m]: amplitude of the telescope's slower wave, the quicker one has half of it; `period` [s] between rows.
  TelescopeMachine(double travel, double period, std::uint64_t seed) {
    const Mat3 along_z = Mat3::Identity(), along_y = exp_so3(Vec3(-0.5 * std::numbers::pi, 0.0, 0.0)),
               along_x = exp_so3(Vec3(0.0, 0.5 * std::numbers::pi, 0.0));
    bodies = {{.sensor = 0},
              revolute_body(0, 1, along_z, along_z),
              revolute_body(1, 2, along_y, along_y),
              prismatic_body(2, 3, along_x, along_x),
              revolute_body(3, 4, along_y, along_y)};
    const std::array<Vec3, 4> in_parent{Vec3(0.1, 0.2, 0.3), Vec3(0.3, 0.0, 0.2), Vec3(0.7, -0.1, 0.0),
                                        Vec3(0.6, 0.0, 0.1)};
    const std::array<Vec3, 4> in_child{Vec3(-0.3, 0.1, -0.2), Vec3(-0.6, 0.0, 0.1), Vec3(0.0, 0.0, 0.0),
                                       Vec3(-0.3, 0.1, 0.05)};
    for (std::size_t j = 0; j < 4; ++j) {
      bodies[j + 1].point_in_parent = in_parent[j];
      bodies[j + 1].point_in_child = in_child[j];
    }
    amplitude_ = {0.45, 0.45, travel, 0.45};
    Rng rng(seed);
    for (std::size_t j = 0; j < 4; ++j)
      waves_[j] = {rng.uniform(0.25, 0.5), rng.uniform(0.5, 0.9), rng.uniform(0, 6), rng.uniform(0, 6)};
    recording.loggers = {{.name = "log", .time = {}}};
    std::array<Vec3, 5> rate_bias, force_bias;
    for (std::size_t s = 0; s < 5; ++s) {
      recording.sensors.push_back(
          {.name = "ins" + std::to_string(s), .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}});
      rate_bias[s] = normal(rng, 2e-3), force_bias[s] = normal(rng, 0.01);
    }
    const auto rows = static_cast<std::size_t>(length / period);
    for (std::size_t row = 0; row < rows; ++row) {
      const double t = period * static_cast<double>(row);
      recording.loggers[0].time.push_back(t);
      InsState state;
      state.force = Vec3(0.0, 0.0, 9.81);
      for (std::size_t s = 0; s < 5; ++s) {
        if (s > 0) state = propagated(bodies[s], position_at(s - 1, t), state);
        const Vec3 rate_noise = normal(rng, 1.2e-3), force_noise = normal(rng, 0.012);
        put(recording.sensors[s], state.angular_velocity + rate_bias[s] + rate_noise,
            state.force + force_bias[s] + force_noise);
      }
    }
  }

 private:
  static constexpr double rest = 4.0, each = 5.0, pause = 0.5, together = 12.0;  // [s]
  static constexpr double length = rest + 4.0 * (each + pause) + together;

  static Vec3 normal(Rng& rng, double sd) {
    Vec3 draw;
    for (double& value : draw) value = sd * rng.normal();
    return draw;
  }

  /// From 0 to 1 and back within a second at either end.
  static double fade(double t, double begin, double end) {
    const double x = std::clamp(std::min(t - begin, end - t), 0.0, 1.0);
    return x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
  }

  double position(std::size_t joint, double t) const {
    const double begin = rest + (each + pause) * static_cast<double>(joint);
    const double share = fade(t, begin, begin + each) + fade(t, length - together, length);
    const auto& [slow, quick, first, second] = waves_[joint];
    const double turn = 2.0 * std::numbers::pi * t;
    return amplitude_[joint] * share * (std::sin(slow * turn + first) + 0.5 * std::sin(quick * turn + second));
  }

  JointKinematicState position_at(std::size_t joint, double t) const {
    constexpr double h = 1e-3;  // [s]
    const double before = position(joint, t - h), now = position(joint, t), after = position(joint, t + h);
    return {Vec3(now, 0, 0), Vec3((after - before) / (2.0 * h), 0, 0),
            Vec3((after - 2.0 * now + before) / (h * h), 0, 0)};
  }

  static void put(InsSensor& sensor, const Vec3& rate, const Vec3& force) {
    for (std::size_t k = 0; k < 3; ++k) {
      sensor.angular_velocity.axis[k].push_back(static_cast<float>(rate[static_cast<Eigen::Index>(k)]));
      sensor.acceleration.axis[k].push_back(static_cast<float>(force[static_cast<Eigen::Index>(k)]));
    }
    sensor.faults.push_back(0);
  }

  std::array<double, 4> amplitude_{};             // [rad], [m]
  std::array<std::array<double, 4>, 4> waves_{};  // [Hz], [Hz], [rad], [rad]
};

}  // namespace kinfer::test
