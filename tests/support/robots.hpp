// SPDX-License-Identifier: Apache-2.0
// Robots that several tests use, with known errors and measured without or with noise.
#pragma once

#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/simulate/pose_set.hpp"

namespace kinfer::test {

inline Joint mdh_joint(double a, double alpha_deg, double d, double lower_deg, double upper_deg, int parent) {
  Joint joint;
  MdhLink link;
  link.a = a, link.alpha = alpha_deg * degree, link.d = d;
  joint.link = link;
  joint.parent = parent;
  joint.name = "J" + std::to_string(parent + 2);
  joint.lower = lower_deg * degree, joint.upper = upper_deg * degree;
  return joint;
}

/// Paper 2, table 1; joint limits of docs/development/methods/paper2.md. `d6` [m]: 0.125 as printed, 0.225 with the
/// target's offset.
inline Chain er20(double d6 = 0.225) {
  Chain chain;
  chain.name = "ER20-C10";
  chain.joints = {mdh_joint(0, 0, 0.504, -170, 170, -1), mdh_joint(0.166605, -90, 0, -130, 40, 0),
                  mdh_joint(0.78227, 0, 0, -60, 140, 1), mdh_joint(0.138826, -90, 0.76135, -180, 180, 2),
                  mdh_joint(0, 90, 0, -120, 120, 3),     mdh_joint(0, -90, d6, -180, 180, 4)};
  return chain;
}

/// Paper 2, table 3: mm and degrees, rows a alpha d theta.
inline Chain with_table3_errors(Chain chain) {
  constexpr double a[] = {0.1, 0.05, 0.065, 0.06, 0.03, 0.25}, d[] = {0.05, 0.1, 0.05, 0.008, 0.36, 0.01};
  constexpr double theta[] = {0.01, 0.015, 0.003, 0.012, 0.008, 0.025},
                   alpha[] = {0.01, 0.005, 0.015, 0.006, 0.004, 0.125};
  for (int i = 0; i < 6; ++i) {
    auto& link = std::get<MdhLink>(chain.joints[i].link);
    link.a += 1e-3 * a[i], link.d += 1e-3 * d[i], link.theta += theta[i] * degree, link.alpha += alpha[i] * degree;
  }
  return chain;
}

/// Tool above the floor and more than 350 mm from axis 1.
inline PoseSimulation paper2_poses(int poses, Instrument instrument) {
  return {.poses = poses, .space = {.lowest = 0.0, .clearance = 0.35}, .instrument = instrument};
}

inline PoseSet measured(const Chain& truth, const PoseSimulation& simulation, int seed = 1) {
  return simulate_pose_set(truth, simulation, Rng(seed)).value();
}

inline constexpr Instrument noise_free{};
inline constexpr Instrument tracker{.sigma = 10e-6, .sigma_angle = 1e-5, .ppm = 5.0};

/// The nominal model of many tests: paper 2's robot with a target off the last axis.
inline Chain nominal_robot() {
  Chain chain = er20(0.125);
  chain.tool.xyz = Vec3(0.03, 0.02, 0.1);
  return chain;
}

}  // namespace kinfer::test
