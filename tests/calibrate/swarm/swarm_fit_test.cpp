// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/swarm/swarm_fit.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/parameters/population_prior.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

constexpr double d6 = 0.225;  // [m] printed 125 mm plus the target's 100 mm, which tables 4 and 5 fit

CalibrationTask noise_free_task() {
  const Chain truth = with_table3_errors(er20(d6));
  return {er20(d6), {}, noise_free, measured(truth, paper2_poses(50, noise_free)), {}, {}};
}

SwarmSearchOptions within(int iterations, SearchOptions search = PsoOptions{}) {
  if (auto* qpso = std::get_if<QpsoOptions>(&search)) qpso->schedule = iterations;
  return {.search = with_budget(search, {.max_iterations = iterations})};
}

Estimate search(const CalibrationTask& task, const SwarmSearchOptions& options, int seed = 1) {
  return fit_by_swarm(task, task.data, PaperDhParameters{}, {}, options, Rng(seed)).value();
}

double rms_error(const Chain& chain, const PoseSet& data) {
  return rms(point_errors(chain, data));
}

TEST(SwarmFit, PsoReachesThePapersAccuracyWithinThePapers404Iterations) {
  const CalibrationTask task = noise_free_task();
  const Estimate found = search(task, within(404));
  EXPECT_LT(rms_error(found.chain, task.data), 7.45e-6);
  EXPECT_EQ(found.search.method, SearchMethod::pso);
  EXPECT_EQ(found.search.best.size(), 405u);
  EXPECT_EQ(found.search.median.size(), 405u);
  EXPECT_NEAR(found.search.cost, 50 * std::pow(rms_error(found.chain, task.data), 2), 1e-15);  // eq. (11)
}

TEST(SwarmFit, QpsoComesBelowATenthOfAMillimetre) {
  const CalibrationTask task = noise_free_task();
  EXPECT_LT(rms_error(search(task, within(600, QpsoOptions{})).chain, task.data), 0.1e-3);
}

TEST(SwarmFit, TheBoundsAreAMillimetreAndADegreeOrAMultipleOfTheTolerances) {
  const CalibrationTask task = noise_free_task();
  const PreparedFit prepared = prepare_fit(task, task.data, PaperDhParameters{}).value();
  const Bounds paper = make_search_box(prepared, {});
  const Bounds wide = make_search_box(prepared, {.box = ToleranceBox{3.0}});
  const auto free = prepared.parameters.free();
  for (std::size_t k = 0; k < free.size(); ++k) {
    const bool length = free[k]->quantity == Quantity::length;
    EXPECT_NEAR(paper.half_width()[k], length ? 1e-3 : degree, 1e-15);
    EXPECT_NEAR(wide.half_width()[k], length ? 1.5e-3 : 0.3 * degree, 1e-15);
  }
}

TEST(SwarmFit, TheNetOfOneCalibrationShortensTheNext) {
  CalibrationTask task = noise_free_task();
  const Estimate first = search(task, within(404, BpnnPsoOptions{}));
  ASSERT_FALSE(first.search.net.empty());
  task.earlier = first.chain;
  BpnnPsoOptions bpnn{.net = parse_mlp(first.search.net, "net").value()};
  const auto runs = swarm_comparison(task, task.data, PaperDhParameters{}, {}, within(1000, bpnn),
                                     with_table3_errors(er20(d6)), Rng(2));
  ASSERT_TRUE(runs);
  ASSERT_EQ(runs->size(), 4u);
  EXPECT_EQ((*runs)[0].initial, InitialSwarm::uniform);
  EXPECT_EQ((*runs)[3].initial, InitialSwarm::network);
  ASSERT_GT((*runs)[3].iterations, 0);
  const int cold = (*runs)[0].iterations < 0 ? 1000 : (*runs)[0].iterations;
  EXPECT_LT((*runs)[3].iterations, 0.6 * cold);
  EXPECT_LE((*runs)[2].iterations, 1);  // and the warm start alone needs no net
}

TEST(SwarmFit, ANetForOtherParametersIsRefused) {
  const CalibrationTask task = noise_free_task();
  const Bounds other{VectorXd::Zero(3), VectorXd::Ones(3)};
  const BpnnPsoOptions bpnn{.net = initialise_mlp(other, other, 5, Rng(1))};
  const auto found = fit_by_swarm(task, task.data, PaperDhParameters{}, {}, within(5, bpnn), Rng(1));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().what, "the network of the earlier calibration has 3 parameters, but 24 are to be identified");
}

TEST(Calibrate, ASwarmSearchIsValidatedLikeLeastSquares) {
  const CalibrationTask task = noise_free_task();
  CalibrationOptions options{.parameters = PaperDhParameters{}};
  options.swarm_search = within(400);
  const Calibration c = calibrate_robot(task, options, Rng(1)).value();
  EXPECT_EQ(c.estimate.search.method, SearchMethod::pso);
  EXPECT_EQ(c.after.position.holdout.n, 50);
  EXPECT_TRUE(c.geometry_only);
  EXPECT_TRUE(c.model_selection.steps.empty());
  EXPECT_LT(c.after.position.holdout.mean, 0.1 * c.before.position.holdout.mean);
  for (const int threads : {1, 7}) {
    options.threads = threads;
    EXPECT_EQ(calibrate_robot(task, options, Rng(1)).value().after.position.holdout.mean,
              c.after.position.holdout.mean);
  }
}

TEST(SwarmFit, APopulationPriorNeedsTheInstrumentsNoise) {
  CalibrationTask task = noise_free_task();
  task.instrument.reset();
  task.robot_population = {er20(d6)};
  const auto c = calibrate_robot(task, {.parameters = PaperDhParameters{}, .swarm_search = within(5)}, Rng(1));
  ASSERT_FALSE(c);
  EXPECT_NE(c.error().what.find("expected [instrument] sigma"), std::string::npos) << c.error().what;
}

TEST(PopulationPrior, MeanAndSpreadCountTheNominalModelAsOneRobot) {
  const Chain nominal = er20(d6);
  std::vector<Chain> robot_population(3, nominal);
  for (int i = 0; i < 3; ++i)
    std::get<MdhLink>(robot_population[i].joints[1].link).a += 1e-3 * (i + 1);  // +1, +2, +3 mm
  const ParameterSet set = paper_dh_parameters(nominal, {}).value();
  const ParameterSet informed = with_population_prior(set, robot_population);
  const double a2 = set.find("a2")->nominal;
  EXPECT_NEAR(informed.find("a2")->nominal, a2 + 1.5e-3, 1e-12);
  EXPECT_NEAR(informed.find("a2")->prior_sd, std::sqrt((0.25 + 0.25 + 0.25 + 2.25) / 4.0) * 1e-3, 1e-12);
  EXPECT_NEAR(informed.find("a3")->prior_sd, 0.25e-3, 1e-12);  // all agree: half the tolerance of 0.5 mm
}

TEST(PopulationPrior, CovarianceIsThatOfThePopulationWithTheTolerancesAsOneMoreRobot) {
  const Chain nominal = er20(d6);
  const ParameterSet set = paper_dh_parameters(nominal, {}).value();
  const VectorXd at = pack(set, nominal);
  VectorXd tolerance(24);
  for (int k = 0; k < 24; ++k) tolerance[k] = set.free()[k]->prior_sd;
  MatrixXd off(24, 2);  // fewer robots than parameters
  Rng rng(3);
  for (double& v : off.reshaped()) v = rng.normal();
  std::vector<Chain> robot_population;
  for (int i = 0; i < 2; ++i)
    robot_population.push_back(unpack(set, nominal, at + VectorXd(tolerance.cwiseProduct(off.col(i)))));
  const ParameterSet informed = with_population_prior(set, robot_population);

  const VectorXd mean = at + VectorXd(tolerance.cwiseProduct(off.rowwise().sum())) / 3.0;
  MatrixXd covariance = tolerance.cwiseAbs2().asDiagonal();
  for (const Chain& robot : robot_population)
    covariance += (pack(set, robot) - mean) * (pack(set, robot) - mean).transpose();
  covariance /= 3.0;
  EXPECT_LT((nominal_of(informed) - mean).norm(), 1e-12);
  const MatrixXd rows = prior_sqrt_information_of(informed), both = covariance * rows.transpose() * rows;
  EXPECT_LT((both - MatrixXd::Identity(24, 24)).norm(), 1e-8);
  for (int k = 0; k < 24; ++k) EXPECT_NEAR(informed.free()[k]->prior_sd, std::sqrt(covariance(k, k)), 1e-12);
}

TEST(PopulationPrior, ErrorsThatAreCorrelatedInThePopulationDetermineEachOther) {
  // In every other robot a2 and a3 are wrong by the same amount: their sum, which few poses determine best, gives both.
  const Chain nominal = er20(d6);
  const auto robot = [&](double error) {
    Chain chain = nominal;
    std::get<MdhLink>(chain.joints[1].link).a += error, std::get<MdhLink>(chain.joints[2].link).a += error;
    return chain;
  };
  CalibrationTask task{nominal, {}, noise_free, measured(robot(0.8e-3), paper2_poses(30, noise_free)), {}, {}};
  for (const double error : {-1e-3, -0.5e-3, 0.5e-3, 1e-3}) task.robot_population.push_back(robot(error));
  const ParameterSet informed = prepare_fit(task, task.data, PaperDhParameters{}).value().parameters;
  const MatrixXd rows = prior_sqrt_information_of(informed);
  const auto price = [&](double a2, double a3) {
    VectorXd x = nominal_of(informed);
    for (std::size_t k = 0; k < informed.free().size(); ++k) {
      if (informed.free()[k]->name == "a2") x[k] += a2;
      if (informed.free()[k]->name == "a3") x[k] += a3;
    }
    return (rows * (x - nominal_of(informed))).squaredNorm();
  };
  EXPECT_LT(price(0.5e-3, 0.5e-3), 0.3 * price(0.5e-3, -0.5e-3));
}

TEST(PopulationPrior, FewPosesAndAPopulationBeatFewPosesAlone) {
  const Chain truth = with_table3_errors(er20(d6));
  const Instrument laser{.sigma = 10e-6, .sigma_angle = 0.0, .ppm = 5.0};
  CalibrationTask task{er20(d6), {}, laser, measured(truth, paper2_poses(4, laser)), {}, {}};
  const PoseSet unseen = measured(truth, paper2_poses(100, noise_free), 99);
  const auto error = [&] {
    return mean(point_errors(fit_once(task, task.data, PaperDhParameters{}, {}).value().chain, unseen));
  };
  const double alone = error();
  // Robots of one type: common machining errors, and individual ones of ±30 µm, ±0.003°.
  const ParameterSet set = paper_dh_parameters(truth, {}).value();
  for (int i = 0; i < 4; ++i) {
    Rng rng = Rng(7).stream(i);
    VectorXd x = pack(set, truth);
    for (Eigen::Index k = 0; k < x.size(); ++k)
      x[k] += rng.normal() * (set.parameters[k].quantity == Quantity::length ? 30e-6 : 0.003 * degree);
    task.robot_population.push_back(unpack(set, truth, x));
  }
  EXPECT_LT(error(), 0.7 * alone);
}

}  // namespace
}  // namespace kinfer
