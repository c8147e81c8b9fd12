// SPDX-License-Identifier: Apache-2.0
// Matrix types of public interfaces.
#pragma once

#include <Eigen/Core>

namespace kinfer {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using ConstMatrixRef = const Eigen::Ref<const MatrixXd>&;
using ConstVectorRef = const Eigen::Ref<const VectorXd>&;
using VectorRef = Eigen::Ref<VectorXd>;

}  // namespace kinfer
