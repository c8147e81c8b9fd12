// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/small_cholesky.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/rng.hpp"

namespace kinfer {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec6 = Eigen::Matrix<double, 6, 1>;

Mat6 random_matrix(Rng rng) {
  Mat6 m;
  for (double& value : m.reshaped()) value = rng.uniform(-1.0, 1.0);
  return m;
}

TEST(SmallCholesky, TheSolutionOfSixRowsMeetsTheEquations) {
  for (std::uint64_t k = 0; k < 100; ++k) {
    const Mat6 m = random_matrix(Rng(k)), a = m * m.transpose() + 1e-3 * Mat6::Identity();
    const Vec6 b = random_matrix(Rng(k).stream(1)).col(0);
    Vec6 x = b;
    ASSERT_TRUE(solve_six(a, x));
    EXPECT_LT((a * x - b).norm(), 1e-12 * a.norm() * x.norm());
  }
}

TEST(SmallCholesky, SixRowsThatAreNotPositiveDefiniteLeaveTheRightSideAsItWas) {
  Mat6 a = Mat6::Identity();
  a(4, 4) = -1.0;
  Vec6 x = Vec6::Ones();
  EXPECT_FALSE(solve_six(a, x));
  EXPECT_EQ(x, Vec6(Vec6::Ones()));
}

}  // namespace
}  // namespace kinfer
