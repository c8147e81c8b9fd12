// SPDX-License-Identifier: Apache-2.0
// One identification problem of the study, and its conditions.
#pragma once

#include <optional>
#include <string>

#include "er20.hpp"
#include "kinfer/measurement/pose_set.hpp"
#include "kinfer/search/swarm/bounds.hpp"

namespace kinfer::paper2 {

struct Problem {
  Chain nominal;                ///< with the assumed base and tool
  Chain truth;                  ///< the real robot, where it is simulated
  ParameterSet parameters;      ///< table 2's 24
  PoseSet fit, verify;          ///< 50 poses each
  Bounds box;                   ///< about the nominal numbers
  Instrument instrument{};      ///< of the noise that was added
  double target_rms = 7.45e-6;  ///< [m] rms of table 4: its fitness 5.55e-5 mm² read as a mean
};

/// What differs from the noise-free simulation of section 4.
struct Conditions {
  double d6 = d6_with_target;
  double drift = 0.0;          ///< every error changes by this share of itself times a standard normal number
  bool collision = false;      ///< joint 3 slips by 0.15°, link 3 is bent by 0.3 mm and 0.05°
  bool another_robot = false;  ///< errors of the size of table 3, drawn anew
  Instrument instrument{};     ///< tracker noise; none: noise-free
};

/// Section 4: table 3's errors, poses by drawn_joints(). `poses` and `errors` are seeds.
Problem simulation(const Conditions& conditions, int poses, int errors);

/// Modelled on section 5: 100 poses, 50/50; table 7's errors, tracker noise, compliant links, and a base that is 0.3 mm
/// and 0.02° off after its preliminary identification. Box ±2 mm, ±1°: table 6 lies outside ±1 mm.
Problem experiment(int poses);

/// Landgraf's UR10 under a Leica tracker (series B): 50 rows to fit, 50 to verify, base and tool fitted before. Nothing
/// where KINFER_DATA is not set. Reads data/ur10 of the project, where `./dev study` runs.
std::optional<Problem> ur10(int rows);

}  // namespace kinfer::paper2
