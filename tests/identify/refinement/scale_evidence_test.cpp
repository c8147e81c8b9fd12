// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/scales/scale_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

constexpr double prior_sd = 1e-3, noise = 3e-4;

/// Every parameter measured once, under a prior of 0 ± prior_sd.
ScaleEstimate estimate_of(const VectorXd& measured) {
  const double prior = 1.0 / (prior_sd * prior_sd), data = 1.0 / (noise * noise);
  const MatrixXd identity = MatrixXd::Identity(measured.size(), measured.size());
  return {data / (data + prior) * measured, identity / (data + prior), prior * identity};
}

VectorXd sample(std::uint64_t seed, Eigen::Index size) {
  Rng rng(seed);
  VectorXd values(size);
  for (double& value : values) value = std::hypot(prior_sd, noise) * rng.normal();
  return values;
}

/// Two groups of nine, and what all have in common.
std::vector<WideningCandidate> groups() {
  MatrixXd first = MatrixXd::Zero(18, 9), second = first;
  first.topRows(9).setIdentity();
  second.bottomRows(9).setIdentity();
  return {{first}, {second}, {MatrixXd::Ones(18, 1)}};
}

/// ln of the density of N(0, C) at x.
double log_density(const VectorXd& x, const MatrixXd& covariance) {
  const SymmetricEigen eigen = symmetric_eigen(covariance);
  const VectorXd along = eigen.vectors.transpose() * x;
  return -0.5 * (along.array().square() / eigen.values.array() + eigen.values.array().log()).sum();
}

TEST(ScaleEvidence, IsTheLikelihoodRatioOfTheWiderPrior) {
  VectorXd measured = sample(1, 18);
  measured.head(9).array() += 0.02;
  const std::vector<WideningCandidate> candidates{groups().front()};
  const auto found = find_widenings(estimate_of(measured), candidates, -7.0);
  ASSERT_EQ(found.size(), 1u);
  const MatrixXd usual = (prior_sd * prior_sd + noise * noise) * MatrixXd::Identity(18, 18),
                 wider = usual +
                         found[0].sd * found[0].sd * candidates[0].directions * candidates[0].directions.transpose();
  EXPECT_NEAR(found[0].log_odds, log_density(measured, wider) - log_density(measured, usual), 1e-6);
  EXPECT_NEAR(found[0].sd, 0.02, 2e-3);
}

TEST(ScaleEvidence, NamesTheGroupThatDeviates) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    VectorXd measured = sample(seed, 18);
    measured.tail(9) *= 10.0;
    const auto found = find_widenings(estimate_of(measured), groups(), -7.0);
    ASSERT_EQ(found.size(), 1u) << seed;
    EXPECT_EQ(found[0].candidate, 1u) << seed;
  }
}

TEST(ScaleEvidence, FindsWhatAllHaveInCommonRatherThanEachByItself) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const VectorXd measured = sample(seed, 18).array() + 0.05;
    const auto found = find_widenings(estimate_of(measured), groups(), -7.0);
    ASSERT_EQ(found.size(), 1u) << seed;
    EXPECT_EQ(found[0].candidate, 2u) << seed;
  }
}

TEST(ScaleEvidence, DoesNotReachWhatNoInstrumentIs) {
  VectorXd measured = sample(1, 18);
  measured.head(9).array() += 0.8;
  std::vector<WideningCandidate> candidates = groups();
  for (WideningCandidate& candidate : candidates) candidate.largest_sd = 0.1;
  for (const Widening& found : find_widenings(estimate_of(measured), candidates, -7.0)) EXPECT_LE(found.sd, 0.1);
}

TEST(ScaleEvidence, IsNoneWhereThePriorIsRight) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed)
    EXPECT_TRUE(find_widenings(estimate_of(sample(seed, 18)), groups(), -7.0).empty()) << seed;
}

}  // namespace
}  // namespace kinfer::identify
