// A calibrated machine as the tables that controllers and colleagues ask for; lengths in mm, angles in degrees.
#pragma once

#include <string>

#include "kinfer/evidence/estimate.hpp"
#include "kinfer/kinematics/joint_table.hpp"

namespace kinfer {

/// joint, type, theta[deg], d[mm], a[mm], alpha[deg], beta[deg], gain: one row a joint of a chain in DH or MDH form.
/// All digits: reading gives the same poses.
std::string joint_rows_csv(const Chain& chain);

/// joint, type, wx, wy, wz, vx[mm], vy[mm], vz[mm]: the twist of each axis in the world at zero readings, v = p × w
/// (prismatic: w = 0, v the direction).
std::string joint_twists_csv(const Chain& chain);

/// joint, offset, sd, unit, identifiable: what has to be added to each zero position, geometry apart.
std::string encoder_offsets_csv(const Chain& nominal, const Estimate& estimate);

/// parameter, then one column a parameter [SI]: covariance of the free parameters.
std::string covariance_csv(const Estimate& estimate);

}  // namespace kinfer
