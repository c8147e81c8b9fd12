// Products and triangular solves of dense blocks of tens to hundreds of rows, for inner loops that have thousands of
// them: as fast as the processor allows whatever the program is compiled for, no memory of their own.
#pragma once

#include "kinfer/linalg/types.hpp"

namespace kinfer {

using MatrixRef = Eigen::Ref<MatrixXd>;

/// to += factor · a bᵀ.
void add_product(ConstMatrixRef a, ConstMatrixRef b, double factor, MatrixRef to);

/// The lower half of to += factor · a aᵀ; what stands above the diagonal may be lost.
void add_square(ConstMatrixRef a, double factor, MatrixRef to);

/// x of x lᵀ = b in place of b, l lower triangular.
void solve_right(ConstMatrixRef l, MatrixRef b);

}  // namespace kinfer
