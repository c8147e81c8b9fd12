// SPDX-License-Identifier: Apache-2.0
// Cholesky factors of matrices of a few rows, for inner loops that have thousands of them.
#pragma once

#include "kinfer/linalg/block_products.hpp"

namespace kinfer {

/// Replaces the lower half of `a` by L, a = L Lᵀ, and clears the upper one; false if `a` is not positive definite.
bool factorise_small(MatrixRef a);

/// Replaces `b` by the solution x of a x = b, a positive definite; false, and `b` as it was, if it is not.
bool solve_six(const Eigen::Matrix<double, 6, 6>& a, Eigen::Matrix<double, 6, 1>& b);

}  // namespace kinfer
