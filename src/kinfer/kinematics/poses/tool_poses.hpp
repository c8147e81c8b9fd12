// SPDX-License-Identifier: Apache-2.0
// Tool poses of a chain at many joint positions.
#pragma once

#include <span>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// world_T_tool of every column of q (dof x n, [rad] or [m]) as 4 x 4 homogeneous matrices, row by row, one after the
/// other: `poses` has 16 n numbers. `threads`: 0: all cores.
void tool_poses(const Chain& chain, ConstMatrixRef q, std::span<double> poses, int threads = 0);

}  // namespace kinfer
