// SPDX-License-Identifier: Apache-2.0
#include "kinfer/geometry/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/student.hpp"

namespace kinfer {
namespace {

TEST(Statistics, LogSumNeitherOverflowsNorVanishes) {
  EXPECT_NEAR(log_sum(std::vector{0.0, 1.0, -2.0}), std::log(1.0 + std::exp(1.0) + std::exp(-2.0)), 1e-14);
  for (const double shift : {1000.0, -1000.0})
    EXPECT_NEAR(log_sum(std::vector{shift, shift}), shift + std::log(2.0), 1e-12);
}

TEST(Statistics, OfFiveNumbersAreThoseComputedByHand) {
  const std::vector<double> values{2, 4, 4, 5, 10};
  EXPECT_DOUBLE_EQ(mean(values), 5.0);
  EXPECT_DOUBLE_EQ(rms(values), std::sqrt(161.0 / 5));
  EXPECT_DOUBLE_EQ(standard_deviation(values), 3.0);  // 9 + 1 + 1 + 0 + 25 = 36 over 4
  EXPECT_DOUBLE_EQ(median(values), 4.0);
  EXPECT_DOUBLE_EQ(robust_sd(values), 1.4826);  // deviations from 4: 2 0 0 1 6
}

TEST(Statistics, OfNothingAreZeroAndOfOneNumberHaveNoSpread) {
  EXPECT_EQ(mean({}), 0.0);
  EXPECT_EQ(rms({}), 0.0);
  EXPECT_EQ(standard_deviation({}), 0.0);
  EXPECT_EQ(standard_deviation(std::vector<double>{3.0}), 0.0);
  EXPECT_EQ(median({3.0}), 3.0);
}

TEST(Statistics, StandardDeviationOfLargeNumbersCloseTogetherKeepsItsDigits) {
  const std::vector<double> values{1e9 + 1, 1e9 + 2, 1e9 + 3};
  EXPECT_DOUBLE_EQ(standard_deviation(values), 1.0);
}

TEST(Quantile, IsLinearBetweenRanksOfUnsortedNumbers) {
  const std::vector<double> values{40, 10, 30, 20};
  EXPECT_DOUBLE_EQ(quantile(values, 0.0), 10.0);
  EXPECT_DOUBLE_EQ(quantile(values, 1.0), 40.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 25.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.25), 17.5);
}

TEST(RobustSd, IsTheSigmaOfAGaussianWithATenthOfGrossErrors) {
  Rng rng(1);
  std::vector<double> values;
  for (int i = 0; i < 20000; ++i) values.push_back(i % 10 == 0 ? 1000.0 : 5.0 + 2.0 * rng.normal());
  // With a tenth on one side the median deviation sits at the 0.556 quantile or so: 15 % up at most.
  EXPECT_NEAR(robust_sd(values), 2.0, 0.35);
}

TEST(NormalQuantile, AgreesWithTheTableAndUndoesTheDistribution) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-13);
  EXPECT_NEAR(normal_quantile(0.5), 0.0, 1e-15);
  EXPECT_NEAR(normal_cdf(1.0), 0.841344746068543, 1e-15);
  for (const double p : {1e-12, 1e-4, 0.1, 0.7, 0.999})
    EXPECT_NEAR(normal_cdf(normal_quantile(p)), p, 1e-14 * p + 1e-16);
}

TEST(ChiSquared, QuantilesAgreeWithTheTable) {
  // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.4: three decimals.
  struct Row {
    double n, p, value;
  };
  for (const Row& row :
       {Row{1, 0.95, 3.841}, Row{1, 0.90, 2.706}, Row{2, 0.95, 5.991}, Row{3, 0.95, 7.815}, Row{3, 0.999, 16.266},
        Row{10, 0.95, 18.307}, Row{10, 0.05, 3.940}, Row{30, 0.975, 46.979}, Row{100, 0.99, 135.807}})
    EXPECT_NEAR(chi_squared_quantile(row.p, row.n), row.value, 5.1e-4) << row.n << " " << row.p;
}

TEST(ChiSquared, OfTwoDegreesIsAnExponentialAndOfOneASquaredGaussian) {
  for (const double p : {1e-6, 0.01, 0.5, 0.9, 0.9999}) {
    EXPECT_NEAR(chi_squared_quantile(p, 2), -2.0 * std::log1p(-p), 1e-10 * -std::log1p(-p));
    const double z = normal_quantile(0.5 * (1 + p));
    EXPECT_NEAR(chi_squared_quantile(p, 1), z * z, 1e-9 * z * z);
  }
}

TEST(ChiSquared, DistributionRisesFromZeroToOneWithoutAStepWhereItsTwoFormulasMeet) {
  for (const double n : {0.5, 1.0, 7.0, 200.0, 5000.0}) {
    const double seam = n + 2.0;
    EXPECT_NEAR(chi_squared_cdf(std::nextafter(seam, 0.0), n), chi_squared_cdf(std::nextafter(seam, 1e9), n), 1e-11)
        << n;
    EXPECT_EQ(chi_squared_cdf(0.0, n), 0.0);
    EXPECT_NEAR(chi_squared_cdf(n + 40 * std::sqrt(2 * n) + 100, n), 1.0, 1e-12);
  }
}

TEST(Student, TailsAgreeWithTheTableAndWithEachOther) {
  // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2: three decimals.
  struct Row {
    int n;
    double tail, t;
  };
  for (const Row& row :
       {Row{1, 0.05, 6.314}, Row{4, 0.05, 2.132}, Row{5, 0.025, 2.571}, Row{30, 0.01, 2.457}, Row{100, 0.05, 1.660}})
    EXPECT_NEAR(student_upper_tail(row.t, row.n), row.tail, 1e-4 * row.tail + 2e-5) << row.n;
  EXPECT_EQ(student_upper_tail(0.0, 7), 0.5);
  EXPECT_EQ(student_upper_tail(-1.3, 6), 1.0 - student_upper_tail(1.3, 6));
}

TEST(FDistribution, QuantilesAgreeWithTheTable) {
  // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.3: three decimals.
  struct Row {
    double n1, n2, p, value;
  };
  for (const Row& row : {Row{3, 5, 0.95, 5.409}, Row{3, 25, 0.95, 2.991}, Row{3, 60, 0.95, 2.758},
                         Row{1, 10, 0.95, 4.965}, Row{10, 20, 0.95, 2.348}, Row{3, 10, 0.99, 6.552}})
    EXPECT_NEAR(f_quantile(row.p, row.n1, row.n2), row.value, 5.1e-4) << row.n1 << " " << row.n2 << " " << row.p;
}

TEST(FDistribution, IsItsReciprocalsWithDegreesExchangedAndChiSquaredForManyOfTheSecond) {
  for (const double p : {1e-6, 0.01, 0.5, 0.9, 0.9999}) {
    EXPECT_NEAR(f_quantile(p, 3, 17) * f_quantile(1.0 - p, 17, 3), 1.0, 1e-9);
    EXPECT_NEAR(f_quantile(p, 3, 1e9), chi_squared_quantile(p, 3) / 3.0, 1e-5 * chi_squared_quantile(p, 3));
    EXPECT_NEAR(f_quantile(p, 2, 2), p / (1.0 - p), 1e-9 * p / (1.0 - p));
  }
}

}  // namespace
}  // namespace kinfer
