// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/update/change_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/identify/update/thresholds.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;

double density(double d, double variance) {
  return std::exp(-0.5 * d * d / variance) / std::sqrt(variance);
}

/// A shift of one parameter.
ChangeHypothesis shift_of(Index parameter, Index parameters) {
  return {.effect = VectorXd::Unit(parameters, parameter), .rotations = 0, .prior_probability = 0.01};
}

TEST(ChangeSearch, WeighsOneShiftAsTheClosedFormDoes) {
  constexpr double sd = 1e-3;
  for (const double d : {2e-3, 6e-3, 2e-2}) {
    double with = 0.0, without = 0.0;
    for (const double inflation : variance_inflations) {
      without += density(d, inflation * sd * sd);
      for (const double size : change_distances) with += density(d, inflation * sd * sd + size * size);
    }
    const double log_odds =
        std::log(with / static_cast<double>(change_distances.size()) / without) + std::log(0.01 / 0.99);
    const auto chosen = choose_changes(VectorXd::Constant(1, d), MatrixXd::Constant(1, 1, sd * sd), {shift_of(0, 1)});
    ASSERT_EQ(chosen.size(), log_odds > 0.0 ? 1u : 0u) << d;
    if (!chosen.empty()) EXPECT_NEAR(chosen.front().log_odds, log_odds, 1e-9);
  }
}

TEST(ChangeSearch, NamesTheSingleCauseOfSeveralDifferences) {
  const Index n = 6;
  VectorXd d = VectorXd::Zero(n);
  d.head<3>().setConstant(0.02);
  ChangeHypothesis common{.effect = MatrixXd::Zero(n, 1), .rotations = 0, .prior_probability = 0.01};
  common.effect.topRows<3>().setOnes();
  std::vector<ChangeHypothesis> all{shift_of(0, n), shift_of(1, n), shift_of(2, n), shift_of(3, n), common};
  const MatrixXd covariance = 1e-6 * MatrixXd::Identity(n, n);
  const auto chosen = choose_changes(d, covariance, all);
  ASSERT_EQ(chosen.size(), 1u);
  EXPECT_EQ(chosen.front().hypothesis, 4u);
  const ChangeEstimate estimate = estimate_changes(d, covariance, {common}, 0.1, 10.0);
  EXPECT_NEAR(estimate.mean[0], 0.02, 1e-9);
  EXPECT_NEAR(std::sqrt(estimate.covariance(0, 0)), 1e-3 / std::sqrt(3.0), 1e-9);
}

TEST(ChangeSearch, NamesTwoIndependentChanges) {
  const Index n = 5;
  VectorXd d = VectorXd::Zero(n);
  d[1] = 0.03, d[4] = -0.01;
  std::vector<ChangeHypothesis> all;
  for (Index i = 0; i < n; ++i) all.push_back(shift_of(i, n));
  const auto chosen = choose_changes(d, 1e-6 * MatrixXd::Identity(n, n), all);
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_EQ(chosen[0].hypothesis, 1u);
  EXPECT_EQ(chosen[1].hypothesis, 4u);
}

TEST(ChangeSearch, FindsNothingInNoise) {
  const Index n = 8;
  std::vector<ChangeHypothesis> all;
  for (Index i = 0; i < n; ++i) all.push_back(shift_of(i, n));
  std::size_t found = 0;
  Rng rng(4);
  for (int trial = 0; trial < 200; ++trial) {
    VectorXd d(n);
    for (double& value : d) value = 1e-3 * rng.normal();
    found += choose_changes(d, 1e-6 * MatrixXd::Identity(n, n), all).size();
  }
  EXPECT_LE(found, 4u) << "8 hypotheses of probability 0.01 each, 200 times";
}

}  // namespace
}  // namespace kinfer
