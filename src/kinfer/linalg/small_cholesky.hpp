// SPDX-License-Identifier: Apache-2.0
// Cholesky factor of a matrix of a few rows, for inner loops that have thousands of them.
#pragma once

#include "kinfer/linalg/block_products.hpp"

namespace kinfer {

/// Replaces the lower half of `a` by L, a = L Lᵀ, and clears the upper one; false if `a` is not positive definite.
bool factorise_small(MatrixRef a);

}  // namespace kinfer
