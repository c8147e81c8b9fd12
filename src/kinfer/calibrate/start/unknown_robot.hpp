// SPDX-License-Identifier: Apache-2.0
// Robots without a data sheet: the chain is estimated from joint types and measurements alone, then rounded to a
// nominal model.
//
// Rounding to the resolution of a data sheet removes the influence of any single row, so the calibration that follows
// can be validated on held-out rows like any other.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/evidence/calibration/unknown_robot.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// How neighbouring axes of a serial chain lie: parallel, intersecting, skew; and three that meet in one point.
AxisGeometry axis_geometry(const Chain& chain);

struct UnknownRobot {
  Chain nominal;          ///< MDH, lengths rounded to 1 mm, angles to 1°
  Tolerances tolerances;  ///< of the rounding
  UnknownRobotEvidence evidence;
};

/// The robot with these joint types that best fits the data. An error where no robot does, or there are too few data.
Result<UnknownRobot> estimate_unknown_robot(const std::vector<JointType>& joint_types, const PoseSet& data, int threads,
                                            Rng rng);

}  // namespace kinfer::calibrate
