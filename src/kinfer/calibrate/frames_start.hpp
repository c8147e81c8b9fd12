// Where the robot's base stands in the instrument's world and where the target sits on the flange, from the data alone:
// no guess is needed from the user.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// `nominal` with base and tool of every mounting, sockets and planes replaced by those that explain the data best with
/// all other numbers as they are.
/// Positions: rigid alignment (Kabsch) for the nominal tool, then base and tool position together under a robust loss.
/// Orientations: base and tool turn by the relative rotations (Park & Martin 1994) first.
/// Sockets: tool and sockets by linear least squares. Tilts: the tool's turn by Wahba's problem for several bases.
/// What the data do not see (the base, where no instrument stands in the world) stays as it is.
/// An error where the poses are too few or do not move. The chain's lists must be those that the data index.
Result<Chain> with_frames_from_data(const Chain& nominal, const PoseSet& data);

}  // namespace kinfer
