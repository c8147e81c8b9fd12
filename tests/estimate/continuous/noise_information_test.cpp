// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/noise_information.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/base/square.hpp"

namespace kinfer {
namespace {

constexpr double many_intervals = 1e12;  // the share is known exactly

MatrixXd discounted(double share, double prior_share = 0.0, double intervals = many_intervals) {
  MatrixXd covariance = 0.25 * MatrixXd::Identity(1, 1);  // information 4
  const MatrixXd white = covariance, prior = prior_share * 4.0 * MatrixXd::Identity(1, 1);
  discount(covariance, white, prior, {{0}, share * 4.0 * MatrixXd::Identity(1, 1), intervals});
  return covariance;
}

TEST(NoiseInformation, OfAShareOfTheInformationCountsTwice) {
  EXPECT_NEAR(discounted(0.0)(0, 0), 0.25, 1e-12);
  EXPECT_NEAR(discounted(0.5)(0, 0), 0.25 / square(0.5), 1e-4);
  EXPECT_NEAR(discounted(0.9)(0, 0), 0.25 / square(0.1), 1e-1);
}

TEST(NoiseInformation, LeavesWhatThePriorKnows) {
  EXPECT_NEAR(discounted(1.0, 0.01)(0, 0), 0.25 / 0.01, 1e-6);
  EXPECT_GT(discounted(1.0)(0, 0), 1e6) << "nothing is known";
}

TEST(NoiseInformation, IsInDoubtWhereFewIntervalsTellIt) {
  EXPECT_GT(discounted(0.5, 0.0, 400.0)(0, 0), 1.2 * discounted(0.5)(0, 0));
}

/// y = c x + noise with an x that is measured with noise, too: the least squares in both have exactly this problem.
TEST(NoiseInformation, ScatterOfALineThroughPointsWithErrorsInBothIsItsStandardDeviation) {
  constexpr int points = 400, trials = 3000;
  constexpr double slope = 0.3, size = 0.7;  // of x, in standard deviations of the noise
  Rng rng(8);
  double squares = 0.0, information = 0.0, share = 0.0;
  for (int trial = 0; trial < trials; ++trial) {
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (int i = 0; i < points; ++i) {
      const double truth = size * std::sqrt(2.0) * std::sin(0.7 * i);
      const double x = truth + rng.normal(), y = slope * truth + rng.normal();
      xx += x * x, xy += x * y, yy += y * y;
    }
    // Deming's line: the least Σ (y − c x)² / (1 + c²).
    const double c = (yy - xx + std::sqrt(square(yy - xx) + 4.0 * xy * xy)) / (2.0 * xy);
    squares += square(c - slope);
    // Of the points on the line, Gauss and Newton's information; that of the noise in them, one each.
    const double n = 1.0 + c * c, estimated = (xx + 2.0 * c * xy + c * c * yy) / (n * n);
    information += estimated / n / trials;
    share += points / (n * n) / (estimated / n) / trials;
  }
  MatrixXd covariance = MatrixXd::Identity(1, 1) / information;
  const MatrixXd white = covariance;
  discount(covariance, white, MatrixXd::Zero(1, 1),
           {{0}, share * information * MatrixXd::Identity(1, 1), many_intervals});
  EXPECT_NEAR(std::sqrt(squares / trials) / std::sqrt(covariance(0, 0)), 1.0, 0.1);
}

}  // namespace
}  // namespace kinfer
