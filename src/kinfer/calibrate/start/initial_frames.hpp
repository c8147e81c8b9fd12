// SPDX-License-Identifier: Apache-2.0
// Initial estimate of the robot's base in the instrument's world frame and of the target on the flange, from the data
// alone: the user need not provide one.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// `nominal` with base and tool of every mounting, sockets and planes fitted to the data, all other parameters fixed.
/// Positions: rigid alignment (Kabsch) for the nominal tool, then base and tool position together under a robust loss.
/// Orientations: base and tool rotation from relative rotations (Park & Martin 1994) first.
/// Sockets: tool and sockets by linear least squares. Tilts: tool rotation by Wahba's problem for several bases.
/// Unobservable frames (the base, if no instrument is fixed in the world) keep their nominal values.
/// An error if there are too few poses. The chain's lists must be those that the data index.
Result<Chain> with_estimated_frames(const Chain& nominal, const PoseSet& data);

}  // namespace kinfer::calibrate
