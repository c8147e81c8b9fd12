// SPDX-License-Identifier: Apache-2.0
#include "kinfer/fleet/population_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr int parameters = 6;

/// Robots about `mean` with correlated first and second parameter, sd 0.5 tolerances; each is measured with `noise`
/// [tolerances] but the last parameter, of which the data say nothing.
struct Population {
  VectorXd mean = VectorXd::LinSpaced(parameters, -2.0, 2.0);
  MatrixXd covariance = 0.25 * MatrixXd::Identity(parameters, parameters);
  Population() { covariance(0, 1) = covariance(1, 0) = 0.2; }

  ParameterInformation robot(Rng rng, double noise) const {
    ParameterInformation robot;
    VectorXd x(parameters), seen(parameters);
    for (int i = 0; i < parameters; ++i) x[i] = rng.normal();
    x = mean + *cholesky(covariance) * x;
    VectorXd weights = VectorXd::Constant(parameters, 1.0 / (noise * noise));
    weights[parameters - 1] = 0.0;
    for (int i = 0; i < parameters; ++i) seen[i] = x[i] + noise * rng.normal();
    for (int i = 0; i < parameters; ++i) robot.names.push_back("theta" + std::to_string(i + 1));
    robot.nominal = VectorXd::Constant(parameters, 0.3);
    robot.tolerance = VectorXd::Constant(parameters, 1e-3);
    robot.information = weights.asDiagonal();
    robot.vector = weights.cwiseProduct(seen);
    return robot;
  }
};

PopulationPrior fit(const std::vector<ParameterInformation>& robots) {
  std::vector<const ParameterInformation*> list;
  for (const ParameterInformation& robot : robots) list.push_back(&robot);
  const auto prior = fleet::fit_population(list);
  EXPECT_TRUE(prior.has_value());
  return prior.value_or(PopulationPrior{});
}

TEST(PopulationFit, FindsMeanAndCovarianceOfManyRobots) {
  const Population truth;
  std::vector<ParameterInformation> robots;
  for (int k = 0; k < 300; ++k) robots.push_back(truth.robot(Rng(1).stream(k), 0.2));
  const PopulationPrior prior = fit(robots);
  EXPECT_EQ(prior.robots, 300);
  const VectorXd mean = (prior.mean - prior.nominal) / 1e-3;
  const MatrixXd covariance = prior.covariance / 1e-6;
  for (int i = 0; i + 1 < parameters; ++i) {
    EXPECT_NEAR(mean[i], truth.mean[i], 0.1) << i;
    EXPECT_NEAR(std::sqrt(covariance(i, i)), 0.5, 0.06) << i;
  }
  EXPECT_NEAR(covariance(0, 1), 0.2, 0.05);
  EXPECT_NEAR(covariance(2, 3), 0.0, 0.05);
}

TEST(PopulationFit, WhatNoRobotTellsKeepsItsTolerance) {
  const Population truth;
  std::vector<ParameterInformation> robots;
  for (int k = 0; k < 30; ++k) robots.push_back(truth.robot(Rng(2).stream(k), 0.2));
  const PopulationPrior prior = fit(robots);
  const Eigen::Index last = parameters - 1;
  EXPECT_NEAR(prior.mean[last], prior.nominal[last], 0.05e-3);
  EXPECT_NEAR(std::sqrt(prior.covariance(last, last)), 1e-3, 0.25e-3);
}

TEST(PopulationFit, RobotsWithPoorDataWeighLittle) {
  const Population truth;
  std::vector<ParameterInformation> good, both;
  for (int k = 0; k < 40; ++k) good.push_back(truth.robot(Rng(3).stream(k), 0.1));
  both = good;
  for (int k = 0; k < 40; ++k) both.push_back(truth.robot(Rng(4).stream(k), 20.0));
  const PopulationPrior without = fit(good), with = fit(both);
  EXPECT_LT(((with.mean - without.mean) / 1e-3).cwiseAbs().maxCoeff(), 0.15);
  for (int i = 0; i + 1 < parameters; ++i)
    EXPECT_NEAR(std::sqrt(with.covariance(i, i) / without.covariance(i, i)), 1.0, 0.35) << i;
}

TEST(PopulationFit, AForeignRobotHardlyMovesIt) {
  const Population truth;
  std::vector<ParameterInformation> robots;
  for (int k = 0; k < 25; ++k) robots.push_back(truth.robot(Rng(5).stream(k), 0.1));
  const PopulationPrior without = fit(robots);
  Population foreign;
  foreign.mean.array() += 30.0;
  robots.push_back(foreign.robot(Rng(6), 0.1));
  const PopulationPrior with = fit(robots);
  for (int i = 0; i + 1 < parameters; ++i)
    EXPECT_LT(std::abs(with.mean[i] - without.mean[i]) / 1e-3, 0.7) << i << ": its mean would move by 1.1";
}

TEST(PopulationFit, FewRobotsKeepMostOfTheirTolerances) {
  const Population truth;
  std::vector<ParameterInformation> robots{truth.robot(Rng(8), 0.1), truth.robot(Rng(9), 0.1)};
  const PopulationPrior prior = fit(robots);
  for (int i = 0; i < parameters; ++i) EXPECT_GT(std::sqrt(prior.covariance(i, i)), 0.5e-3) << i;
  std::vector<const ParameterInformation*> one{&robots[0]};
  EXPECT_FALSE(fleet::fit_population(one).has_value());
}

TEST(PopulationFit, ParametersThatFewRobotsHaveAreLeftOut) {
  const Population truth;
  std::vector<ParameterInformation> robots;
  for (int k = 0; k < 6; ++k) robots.push_back(truth.robot(Rng(10).stream(k), 0.1));
  for (int k = 0; k < 4; ++k) robots[static_cast<std::size_t>(k)].names[0] = "gain" + std::to_string(k);
  const PopulationPrior prior = fit(robots);
  EXPECT_EQ(prior.names.size(), parameters - 1U);
  EXPECT_EQ(prior.names.front(), "theta2");
}

/// The same likelihood in tolerances from other nominal values: u = shift + scale · u'.
ParameterInformation by_data_sheet(ParameterInformation robot, double nominal, double tolerance) {
  const VectorXd shift = (nominal - robot.nominal.array()) / robot.tolerance.array(),
                 scale = tolerance / robot.tolerance.array();
  robot.vector = scale.cwiseProduct(robot.vector - robot.information * shift);
  robot.information = scale.asDiagonal() * robot.information * scale.asDiagonal();
  robot.nominal.setConstant(nominal), robot.tolerance.setConstant(tolerance);
  return robot;
}

TEST(PopulationFit, DoesNotDependOnTheDataSheetsOfFurtherRobots) {
  const Population truth;
  std::vector<ParameterInformation> alike, mixed;
  for (int k = 0; k < 60; ++k) {
    alike.push_back(truth.robot(Rng(11).stream(k), 0.2));
    mixed.push_back(k % 2 == 0 ? alike.back() : by_data_sheet(alike.back(), 0.3012, 2e-3));
  }
  const PopulationPrior expected = fit(alike), found = fit(mixed);
  EXPECT_LT((found.mean - expected.mean).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((found.covariance - expected.covariance).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace kinfer
