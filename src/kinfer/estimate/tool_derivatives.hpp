// Where a chain puts its tool at many readings, and how that place changes with its parameters: what maps of
// uncertainty and the planning of poses are made of.
#pragma once

#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

struct ToolDerivatives {
  Eigen::Matrix3Xd position;  ///< 3 x n [m] in the world
  MatrixXd jacobian;          ///< 3 n x free parameters: of pose i in rows 3 i .. 3 i + 2
};

/// At readings `joints` (dof x n) without load. By the batch kernels where the chain has a batch form.
ToolDerivatives tool_derivatives(const Chain& chain, const ParameterSet& set, ConstMatrixRef joints);

}  // namespace kinfer
