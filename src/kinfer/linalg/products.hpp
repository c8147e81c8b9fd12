// SPDX-License-Identifier: Apache-2.0
// Products of dense matrices behind plain functions: Eigen's templates are compiled once, here. Each allocates its
// result; inner loops use Eigen's operators or block_products.hpp.
#pragma once

#include "kinfer/linalg/types.hpp"

namespace kinfer {

MatrixXd product(ConstMatrixRef a, ConstMatrixRef b);           ///< a b
MatrixXd transposed_times(ConstMatrixRef a, ConstMatrixRef b);  ///< aᵀ b
MatrixXd times_transposed(ConstMatrixRef a, ConstMatrixRef b);  ///< a bᵀ
MatrixXd gram(ConstMatrixRef a);                                ///< aᵀ a

/// J Σ Jᵀ: the covariance of y = J x.
MatrixXd propagated_covariance(ConstMatrixRef jacobian, ConstMatrixRef covariance);

}  // namespace kinfer
