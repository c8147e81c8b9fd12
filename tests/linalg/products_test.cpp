// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/products.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "support/random.hpp"

namespace kinfer {
namespace {

using Eigen::Index;

/// a b entry by entry.
MatrixXd slow_product(const MatrixXd& a, const MatrixXd& b) {
  MatrixXd result = MatrixXd::Zero(a.rows(), b.cols());
  for (Index i = 0; i < a.rows(); ++i)
    for (Index j = 0; j < b.cols(); ++j)
      for (Index k = 0; k < a.cols(); ++k) result(i, j) += a(i, k) * b(k, j);
  return result;
}

TEST(Products, EqualTheSumsOfTheirDefinition) {
  for (const auto& [rows, columns] :
       {std::pair{1, 1}, std::pair{3, 7}, std::pair{40, 12}, std::pair{0, 4}, std::pair{83, 13}}) {
    const MatrixXd a = test::random_matrix(rows, columns, 1), b = test::random_matrix(columns, 5, 2);
    const MatrixXd transposed = a.transpose(), slow = slow_product(a, b);
    EXPECT_LT((product(a, b) - slow).norm(), 1e-13);
    EXPECT_LT((transposed_times(transposed, b) - slow).norm(), 1e-13);
    EXPECT_LT((times_transposed(a, MatrixXd(b.transpose())) - slow).norm(), 1e-13);
    EXPECT_LT((gram(a) - slow_product(transposed, a)).norm(), 1e-12 * (1 + rows));
  }
}

TEST(PropagatedCovariance, IsTheCovarianceOfTheProjection) {
  const MatrixXd root = test::random_matrix(6, 6, 3), jacobian = test::random_matrix(3, 6, 4);
  const MatrixXd projected = slow_product(jacobian, root);
  EXPECT_LT((propagated_covariance(jacobian, slow_product(root, root.transpose())) -
             slow_product(projected, projected.transpose()))
                .norm(),
            1e-12);
}

}  // namespace
}  // namespace kinfer
