// SPDX-License-Identifier: Apache-2.0
// Robots without a data sheet: the chain is estimated from joint types and measurements alone, then rounded to a
// nominal model.
//
// Rounding to the resolution of a data sheet removes the influence of any single row, so the calibration that follows
// can be validated on held-out rows like any other.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/evidence/calibration.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// Describes neighbouring axes of a serial chain: "J2 and J3 are parallel, 612.0 mm apart"; "J4, J5 and J6 meet in one
/// point".
std::vector<std::string> describe_axes(const Chain& chain);

struct UnknownRobot {
  Chain nominal;          ///< MDH, lengths rounded to 1 mm, angles to 1°
  Tolerances tolerances;  ///< of the rounding
  std::vector<std::string> words;
};

/// Verdict on a calibration that started from such a model: there is no earlier model to compare it with.
void conclude_without_nominal(Calibration& calibration);

/// `joint_types` as "6R" or "RRPR".
Result<UnknownRobot> estimate_unknown_robot(const std::string& joint_types, const PoseSet& data, int threads, Rng rng);

}  // namespace kinfer::calibrate
