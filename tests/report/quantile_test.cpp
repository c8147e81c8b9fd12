// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/quantile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace kinfer::report {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(Quantile, OfSortedValuesRunsFromTheFirstToTheLast) {
  const std::vector<double> values{1.0, 2.0, 4.0, 8.0, 16.0};
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 0.5), 4.0);
  EXPECT_EQ(quantile(values, 1.0), 16.0);
  double last = 0.0;
  for (double fraction = 0.0; fraction <= 1.0; fraction += 0.01) {
    EXPECT_GE(quantile(values, fraction), last) << fraction;
    last = quantile(values, fraction);
  }
}

TEST(Quantile, OfNothingIsNoNumber) {
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_EQ(quantile({3.0}, 0.95), 3.0);
}

TEST(FiniteSorted, DropsMissingAndInfiniteValues) {
  EXPECT_EQ(finite_sorted({3.0, NAN, -1.0, infinite, -infinite, 2.0}), (std::vector<double>{-1.0, 2.0, 3.0}));
  EXPECT_TRUE(finite_sorted({NAN}).empty());
}

TEST(RoundDown, GivesOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_EQ(round_down(0.3), 1.0);
  EXPECT_EQ(round_down(1.9), 1.0);
  EXPECT_EQ(round_down(4.9), 2.0);
  EXPECT_EQ(round_down(9.9), 5.0);
  EXPECT_EQ(round_down(230.0), 200.0);
  EXPECT_EQ(round_down(6e4), 5e4);
}

}  // namespace
}  // namespace kinfer::report
