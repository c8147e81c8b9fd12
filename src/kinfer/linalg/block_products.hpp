// SPDX-License-Identifier: Apache-2.0
// Products and triangular solves of dense blocks of tens to hundreds of rows, for inner loops that have thousands of
// them: the instruction set is chosen at run time, and nothing is allocated.
#pragma once

#include "kinfer/linalg/types.hpp"

namespace kinfer {

using MatrixRef = Eigen::Ref<MatrixXd>;

/// to += factor · a bᵀ.
void add_product(ConstMatrixRef a, ConstMatrixRef b, double factor, MatrixRef to);

/// The lower half of to += factor · a aᵀ; entries above the diagonal may be overwritten.
void add_square(ConstMatrixRef a, double factor, MatrixRef to);

/// Solves x lᵀ = b for a lower triangular l; x replaces b.
void solve_right(ConstMatrixRef l, MatrixRef b);

}  // namespace kinfer
