// SPDX-License-Identifier: Apache-2.0
// The marginal likelihood by which terms weigh themselves, against dense formulas.
#include "kinfer/calibrate/terms/relevance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/base/rng.hpp"
#include "kinfer/calibrate/terms/candidate_terms.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

/// y = G g + T u + noise of standard deviation 1: two nuisance parameters g of prior sd 100, six terms u in three
/// groups of which the second has an effect.
struct LinearModel {
  MatrixXd nuisance, terms;
  VectorXd y;
  std::vector<RelevanceGroup> groups{{{0, 1}, 0}, {{2, 3}, 1}, {{4, 5}, 2}};
};

LinearModel linear_model(int rows, double effect, int seed) {
  Rng rng(seed);
  LinearModel model{MatrixXd(rows, 2), MatrixXd(rows, 6), VectorXd(rows)};
  for (double& value : model.nuisance.reshaped()) value = rng.normal();
  for (double& value : model.terms.reshaped()) value = rng.normal();
  for (double& value : model.y) value = rng.normal();
  model.y += model.nuisance * Eigen::Vector2d(3.0, -5.0) + effect * (model.terms.col(2) - model.terms.col(3));
  return model;
}

constexpr double nuisance_sd = 100.0;

/// log N(y; 0, noise² I + 100² G Gᵀ + T diag(f²) Tᵀ), the long way.
double dense_log_likelihood(const LinearModel& model, const std::vector<double>& factors, double noise = 1.0) {
  const Eigen::Index n = model.y.size();
  MatrixXd covariance = noise * noise * MatrixXd::Identity(n, n) +
                        nuisance_sd * nuisance_sd * model.nuisance * model.nuisance.transpose();
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    for (const int k : model.groups[g].members)
      covariance += factors[g] * factors[g] * model.terms.col(k) * model.terms.col(k).transpose();
  const MatrixXd root = *cholesky(covariance);
  const VectorXd white = *solve_spd(covariance, model.y);
  return -0.5 * model.y.dot(white) - root.diagonal().array().log().sum() -
         0.5 * static_cast<double>(n) * std::log(2.0 * std::numbers::pi);
}

/// The MAP fit of all, as an estimate with priors of 1 for the terms.
Estimate fit_of(const LinearModel& model, double noise = 1.0) {
  MatrixXd columns(model.y.size(), 8);
  columns << model.nuisance, model.terms;
  Estimate fit;
  MatrixXd normal = columns.transpose() * columns / (noise * noise);
  for (int k = 0; k < 8; ++k) {
    const double sd = k < 2 ? nuisance_sd : 1.0;
    normal(k, k) += 1.0 / (sd * sd);
    Parameter parameter;
    parameter.prior_sd = sd;
    fit.parameters.parameters.push_back(parameter);
  }
  fit.covariance = *invert_spd(normal);
  const VectorXd x = fit.covariance * (columns.transpose() * model.y) / (noise * noise);
  for (int k = 0; k < 8; ++k) {
    ParameterEstimate estimate;
    estimate.value = x[k];
    fit.values.push_back(estimate);
  }
  return fit;
}

LinearisedTerms linearised(const LinearModel& model, double noise = 1.0) {
  return linearise_terms(fit_of(model, noise), std::vector{2, 3, 4, 5, 6, 7});
}

std::vector<TermsAtNoise> known_noise(const LinearModel& model) {
  return {{linearised(model)}};
}

constexpr double noises[] = {0.5, 0.7, 1.0, 1.4, 2.0};

std::vector<TermsAtNoise> unknown_noise(const LinearModel& model) {
  std::vector<TermsAtNoise> levels;
  for (const double noise : noises)
    levels.push_back(
        {linearised(model, noise), dense_log_likelihood(model, std::vector(model.groups.size(), 0.0), noise)});
  return levels;
}

TEST(Relevance, TheEvidenceIsThatOfTheDenseGaussian) {
  const LinearModel model = linear_model(30, 0.7, 1);
  const std::vector<TermsAtNoise> terms = known_noise(model);
  const double none = dense_log_likelihood(model, {0, 0, 0});
  for (const std::vector<double>& factors :
       {std::vector{1.0, 1.0, 1.0}, std::vector{0.0, 0.5, 0.0}, std::vector{0.1, 2.0, 30.0}})
    EXPECT_NEAR(log_evidence(terms, model.groups, factors), dense_log_likelihood(model, factors) - none, 1e-6);
}

TEST(Relevance, TheEvidenceOfUnknownNoiseIsTheSumOverItsLevels) {
  const LinearModel model = linear_model(30, 0.7, 1);
  const auto sum = [&](const std::vector<double>& factors) {
    double likelihood = 0.0;  // over that of noise 1, lest it vanish
    for (const double noise : noises)
      likelihood += std::exp(dense_log_likelihood(model, factors, noise) - dense_log_likelihood(model, factors));
    return std::log(likelihood) + dense_log_likelihood(model, factors);
  };
  for (const std::vector<double>& factors : {std::vector{1.0, 1.0, 1.0}, std::vector{0.0, 0.5, 0.0}})
    EXPECT_NEAR(log_evidence(unknown_noise(model), model.groups, factors), sum(factors) - sum({0, 0, 0}), 1e-6);
}

TEST(Relevance, AGroupsGainIsTheIntegralOverItsSizeAndTheNoise) {
  LinearModel model = linear_model(30, 0.7, 2);
  model.groups = {{{2, 3}, 0}};
  double with = 0.0, without = 0.0;
  constexpr double step = 0.01;
  const double scale = dense_log_likelihood(model, {0});
  for (const double noise : noises) {
    without += std::exp(dense_log_likelihood(model, {0}, noise) - scale);
    for (double log_f = std::log(1e-3); log_f < 0.0; log_f += step) {
      const double f = std::exp(log_f);
      with +=
          step * 4.0 / std::numbers::pi * f / (1.0 + f * f) * std::exp(dense_log_likelihood(model, {f}, noise) - scale);
    }
  }
  EXPECT_NEAR(weigh_groups(unknown_noise(model), model.groups)[0].log_evidence_gain,
              std::log(with / without) - std::log(2.0), 0.02);
}

TEST(Relevance, AGroupsGainIsTheIntegralOverItsSize) {
  LinearModel model = linear_model(30, 0.7, 2);
  model.groups = {{{2, 3}, 0}};
  const double none = dense_log_likelihood(model, {0});
  double sum = 0.0;
  constexpr double step = 0.01;  // of log f; the half-Cauchy density of f below 1, times f
  for (double log_f = std::log(1e-3); log_f < 0.0; log_f += step) {
    const double f = std::exp(log_f);
    sum += step * 4.0 / std::numbers::pi * f / (1.0 + f * f) * std::exp(dense_log_likelihood(model, {f}) - none);
  }
  const std::vector<GroupRelevance> weights = weigh_groups(known_noise(model), model.groups);
  EXPECT_NEAR(weights[0].log_evidence_gain, std::log(sum) - std::log(2.0), 0.02)
      << "one candidate or none: odds 1 to 2";
}

TEST(Relevance, TheGroupWithAnEffectIsKeptAndTheOthersVanish) {
  int wrong = 0;
  for (int seed = 1; seed <= 40; ++seed) {
    const LinearModel model = linear_model(40, 1.0, seed);
    const auto weights = weigh_groups(known_noise(model), model.groups);
    EXPECT_GT(weights[1].factor, 0.3) << seed;
    wrong += weights[0].factor > 0.0 || weights[2].factor > 0.0;
  }
  EXPECT_LE(wrong, 3);
}

/// Three joints of one term, of which the second certainly has it: f² of another is its probability times its square.
TEST(Relevance, AJointsSizeIsTheRootOfItsExpectedSquare) {
  int between = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    LinearModel model = linear_model(40, 1.0, seed);
    for (RelevanceGroup& group : model.groups) group.family = 0;
    model.y += 0.2 * model.terms.col(0);
    const auto weights = weigh_groups(known_noise(model), model.groups);
    const double centre = weights[1].factor;
    if (weights[2].factor > 0.0) continue;  // so that the first is beside the second alone
    const double none = dense_log_likelihood(model, {0.0, centre, 0.0});
    double sum = 0.0, most = 0.0, likeliest = 0.0;
    constexpr double step = 0.01;
    for (double log_f = std::log(1e-3); log_f < 0.0; log_f += step) {
      const double z = log_f - std::log(centre), f = std::exp(log_f),
                   value = std::exp(dense_log_likelihood(model, {f, centre, 0.0}) - none - 0.5 * z * z) /
                           std::sqrt(2.0 * std::numbers::pi);
      sum += step * value;
      if (value > most) most = value, likeliest = f;
    }
    const double probability = sum / (1.0 + sum), expected = std::sqrt(probability) * likeliest;
    if (probability > 0.8 || std::abs(probability - 0.1) < 0.02) continue;  // above, it moves the centre
    EXPECT_NEAR(weights[0].factor, probability > 0.1 ? expected : 0.0, 0.15 * expected) << seed;
    between += probability > 0.1;
  }
  EXPECT_GE(between, 2);
}

TEST(Relevance, WithoutAnyEffectHardlyAnyGroupIsKept) {
  int kept = 0;
  for (int seed = 1; seed <= 40; ++seed) {
    const LinearModel model = linear_model(40, 0.0, seed);
    for (const GroupRelevance& group : weigh_groups(known_noise(model), model.groups)) kept += group.factor > 0.0;
  }
  EXPECT_LE(kept, 3);
}

TEST(Relevance, ColumnsThatAreZeroOrEqualDoNoHarm) {
  LinearModel model = linear_model(40, 1.0, 3);
  model.terms.col(0).setZero(), model.terms.col(1).setZero();
  model.terms.col(4) = model.terms.col(2), model.terms.col(5) = model.terms.col(3);
  const auto weights = weigh_groups(known_noise(model), model.groups);
  EXPECT_EQ(weights[0].factor, 0.0);
  EXPECT_TRUE((weights[1].factor > 0.0) != (weights[2].factor > 0.0)) << "one of two equal groups";
}

/// As of two rows with a noise of nanometres: of the sum with the priors rounding leaves an indefinite matrix.
TEST(Relevance, InformationThatDwarfsThePriorsIsWeighed) {
  Rng rng(5);
  VectorXd effect(6);
  for (double& value : effect) value = 1e10 * rng.normal();
  LinearisedTerms terms{effect * effect.transpose(), 1e10 * effect};
  terms.information.diagonal().array() -= 1e4;
  for (const GroupRelevance& group : weigh_groups({{terms}}, LinearModel{}.groups))
    EXPECT_TRUE(std::isfinite(group.factor) && std::isfinite(group.log_evidence_gain));
}

TEST(Relevance, MoreTermsThanMeasurementsAreWeighed) {
  LinearModel model = linear_model(4, 0.0, 4);
  for (const GroupRelevance& group : weigh_groups(known_noise(model), model.groups))
    EXPECT_TRUE(std::isfinite(group.factor) && std::isfinite(group.log_evidence_gain));
}

}  // namespace
}  // namespace kinfer
