// SPDX-License-Identifier: Apache-2.0
// Tool positions of a chain at many joint positions, and their derivatives with respect to the parameters: for
// uncertainty maps and pose planning.
#pragma once

#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

struct ToolDerivatives {
  Eigen::Matrix3Xd position;  ///< 3 x n [m] in the world frame
  MatrixXd jacobian;          ///< 3 n x free parameters; pose i in rows 3 i .. 3 i + 2
};

/// At joint positions `joints` (dof x n) without load. By the batch kernels if the chain has a batch form.
ToolDerivatives tool_derivatives(const Chain& chain, const ParameterSet& set, ConstMatrixRef joints);

}  // namespace kinfer
