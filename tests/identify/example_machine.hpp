// SPDX-License-Identifier: Apache-2.0
// A small machine that moves smoothly and is measured without error: a base at rest and two revolute joints, with
// sensors in general position.
#pragma once

#include <cmath>

#include "kinfer/identify/geometry/joint_geometry.hpp"
#include "kinfer/identify/programming/link_cost.hpp"

namespace kinfer::test {
using namespace identify;

/// theta(t) = amplitude sin(2 pi frequency t + phase) with its exact derivatives, sampled every 0.01 s.
inline JointSignal wave(double amplitude, double frequency, double phase, std::size_t rows = 600) {
  JointSignal signal{.name = "q", .angle = {}, .angular_velocity = {}, .angular_acceleration = {}};
  const double w = 2.0 * 3.14159265358979323846 * frequency;
  for (std::size_t row = 0; row < rows; ++row) {
    const double t = 0.01 * static_cast<double>(row);
    signal.angle.push_back(amplitude * std::sin(w * t + phase));
    signal.angular_velocity.push_back(amplitude * w * std::cos(w * t + phase));
    signal.angular_acceleration.push_back(-amplitude * w * w * std::sin(w * t + phase));
  }
  return signal;
}

/// A parent that rotates about an inclined axis, 1.3 m from its sensor.
inline std::vector<FrameState> swinging_parent(const JointSignal& swing) {
  const std::vector<DhLeaf> leaves{{.alpha = 0.4}, {.a = -1.3, .theta_signal = 0}};
  return propagate(std::vector<FrameState>(swing.angle.size()), leaves, {&swing, 1});
}

inline std::vector<std::size_t> all_rows(std::size_t count) {
  std::vector<std::size_t> rows(count);
  for (std::size_t i = 0; i < count; ++i) rows[i] = i;
  return rows;
}

/// A revolute joint in general position, which needs all ten numbers.
inline std::vector<DhLeaf> general_hinge() {
  return {{.theta = 0.7, .d = 0.2, .alpha = -1.1, .a = 0.5},
          {.theta = 0.3, .d = -0.4, .alpha = 0.9, .a = 0.8, .theta_signal = 0},
          {.theta = -1.9, .d = 0.15}};
}

}  // namespace kinfer::test
