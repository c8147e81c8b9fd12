// SPDX-License-Identifier: Apache-2.0
// A calibrated machine as CSV tables for robot controllers and for review; lengths in mm, angles in degrees.
#pragma once

#include <string>

#include "kinfer/evidence/calibration/estimate.hpp"
#include "kinfer/kinematics/dh_conversion.hpp"

namespace kinfer {

/// joint, type, theta[deg], d[mm], a[mm], alpha[deg], beta[deg], gain: one row per joint of a chain in DH or MDH form.
/// Full precision: the table gives the same poses.
std::string format_dh_table_csv(const Chain& chain);

/// joint, type, wx, wy, wz, vx[mm], vy[mm], vz[mm]: the twist of each axis in the world at zero joint positions,
/// v = p × w (prismatic: w = 0, v the direction).
std::string format_joint_twists_csv(const Chain& chain);

/// joint, offset, sd, unit, identifiable: what to add to each joint's zero position, without the other parameters.
std::string format_encoder_offsets_csv(const Chain& nominal, const Estimate& estimate);

/// parameter, then one column per parameter [SI]: covariance of the free parameters.
std::string format_covariance_csv(const Estimate& estimate);

}  // namespace kinfer
