// SPDX-License-Identifier: Apache-2.0
// A hand-moved, shaken chain of three sensors: a root with six degrees of freedom, a revolute joint, and a revolute
// joint whose axis may deviate.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/estimate/continuous/model/mount_compliance.hpp"
#include "kinfer/identify/refinement/refine.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer::test {
using namespace identify;

/// amplitude sin(2π frequency t + phase) with its first two derivatives.
inline std::array<double, 3> wave(double amplitude, double frequency, double phase, double t) {
  const double w = 2.0 * std::numbers::pi * frequency, at = w * t + phase;
  return {amplitude * std::sin(at), amplitude * w * std::cos(at), -amplitude * w * w * std::sin(at)};
}

inline JointKinematicState readings(const std::array<std::array<double, 3>, 3>& waves) {
  JointKinematicState q;
  for (std::size_t order = 0; order < 3; ++order) q[order] = Vec3(waves[0][order], waves[1][order], waves[2][order]);
  return q;
}

/// A root moved by hand, a revolute joint, and one whose axis deviates by `stray` [rad] (rms); all shaken at 6 Hz.
/// `tilt`: compliance of the sensors' mounts [rad per m/s²].
struct HandMovedChain {
  double stray = 0.05;
  Mat3 tilt = Mat3::Zero();
  InsBodies bodies{{.sensor = 0},
                   revolute_body(0, 1, exp_so3(Vec3(0.2, 0.1, -0.3)), exp_so3(Vec3(-0.1, 0.3, 0.2))),
                   spherical_body(1, 2, exp_so3(Vec3(0.1, -0.2, 0.3)))};
  InsRecording recording;

  explicit HandMovedChain(double strays = 0.05, const Mat3& tilts = Mat3::Zero()) : stray(strays), tilt(tilts) {
    bodies[1].point_in_parent = Vec3(0.25, 0.02, -0.03);
    bodies[1].point_in_child = Vec3(-0.15, 0.04, 0.02);
    bodies[2].point_in_parent = Vec3(0.2, 0.0, -0.02);
    bodies[2].point_in_child = Vec3(-0.18, 0.02, 0.03);
    recording.loggers = {{.name = "log", .time = {}}};
    for (const char* name : {"a", "b", "c"})
      recording.sensors.push_back(
          {.name = name, .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}});
    Rng rng(4);
    for (int row = 0; row < 1500; ++row) {
      const double t = 0.02 * row;
      recording.loggers[0].time.push_back(t);
      const auto states = states_at(t), before = states_at(t - moment), after = states_at(t + moment);
      for (std::size_t s = 0; s < 3; ++s)
        put(recording.sensors[s],
            state_on_mount(states[s], tilt, states[s].force, (after[s].force - before[s].force) / (2.0 * moment)), rng);
    }
  }

  static constexpr double moment = 1e-4;  // [s]

  std::vector<InsState> states_at(double t) const {
    // The root rotates by exp(φ) and shifts: its ω is that of a spherical joint on a body at rest.
    InsState ground;
    ground.force = Vec3(0.0, 0.0, 9.81);
    InsBody hand = spherical_body(0, 0, Mat3::Identity());
    JointKinematicState turn = readings({wave(0.5, 0.45, 0.0, t), wave(0.6, 0.37, 1.0, t), wave(0.7, 0.29, 2.0, t)});
    const JointKinematicState shake =
        readings({wave(0.03, 6.0, 0.0, t), wave(0.0, 1.0, 0.0, t), wave(0.02, 5.3, 0.0, t)});
    for (std::size_t order = 0; order < 3; ++order) turn[order] += shake[order];
    const JointKinematicState shift =
        readings({wave(0.3, 0.6, 0.4, t), wave(0.2, 0.5, 0.0, t), wave(0.2, 0.7, 0.9, t)});
    ground.force += shift[2];
    std::vector<InsState> states{propagated(hand, turn, ground)};
    states.push_back(propagated(bodies[1], readings({wave(0.8, 0.41, 0.3, t), {}, {}}), states[0]));
    states.push_back(
        propagated(bodies[2], readings({wave(0.9, 0.52, 1.3, t), wave(stray, 0.23, 1.0, t), wave(stray, 0.31, 0.0, t)}),
                   states[1]));
    return states;
  }

  static void put(InsSensor& sensor, const InsState& state, Rng& rng) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      sensor.angular_velocity.axis[k].push_back(static_cast<float>(state.angular_velocity[i] + 1e-3 * rng.normal()));
      sensor.acceleration.axis[k].push_back(static_cast<float>(state.force[i] + 1e-2 * rng.normal()));
    }
    sensor.faults.push_back(0);
  }
};

inline Refinement refined(const InsRecording& recording, int threads) {
  const auto ordered = order_segments(recording, {}, "a", threads);
  EXPECT_TRUE(ordered);
  std::vector<InitialJoint> starts;
  for (std::size_t i = 1; i < ordered->tree.order.size(); ++i)
    starts.push_back(estimate_initial_joint(ordered->motion, ordered->tree,
                                            *ordered->tree.parent[ordered->tree.order[i]], ordered->tree.order[i],
                                            EstimatedJointType::revolute));
  auto result = refine(recording, ordered->motion, ordered->tree, starts, {.fit = {.threads = threads}});
  EXPECT_TRUE(result);
  return *result;
}

}  // namespace kinfer::test
