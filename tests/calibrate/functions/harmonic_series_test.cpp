// SPDX-License-Identifier: Apache-2.0
// Errors of joints that are smooth functions of their positions, of any form.
#include "kinfer/calibrate/functions/harmonic_series.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calibrate/functions/nominal_fits.hpp"
#include "calibrate/terms/simulated_selection.hpp"
#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/deploy/predict.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/words/calibration/model.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

/// [rad] No harmonic of the joint: a wave whose phase runs ever faster.
double bent(double q) {
  return 4e-4 * std::sin(5.0 * q + 1.5 * q * q);
}

/// Points of a robot whose joints `bent_joints` deviate so.
PoseSet bent_readings(const Chain& truth, int poses, const std::vector<int>& bent_joints, int seed = 1) {
  PoseSet data = simulated_readings(truth, poses, seed);
  PoseSet moved = data;
  for (const int joint : bent_joints)
    for (double& q : moved.joints.row(joint)) q += bent(q);
  measure_points(moved, truth, tracker, Rng(seed + 50));
  data.points = moved.points;
  return data;
}

std::vector<int> joints_with_series(const Chain& chain) {
  std::vector<int> joints;
  for (int j = 0; j < static_cast<int>(chain.joints.size()); ++j)
    if (series_order(chain.joints[j]) > 0) joints.push_back(j);
  return joints;
}

TEST(HarmonicSeries, AreFoundForTheJointsThatHaveThem) {
  const PoseSet data = bent_readings(nominal_robot(), 600, {1, 2});
  const Estimate geometry = geometry_of(data);
  const auto found = find_series(geometry, data, tracker);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(joints_with_series(found->chain), (std::vector{1, 2}));
  const Estimate fit = fit_with_series(found->chain, found->parameters, data, tracker, {});
  const PoseSet unseen = bent_readings(nominal_robot(), 200, {1, 2}, 7);
  EXPECT_LT(mean_error(fit.chain, unseen), 0.25 * mean_error(geometry.chain, unseen));
}

TEST(HarmonicSeries, FollowTheFunctionWhereItWasMeasuredAndReturnToZeroElsewhere) {
  PoseSet data = bent_readings(nominal_robot(), 600, {1});
  const auto found = find_series(geometry_of(data), data, tracker);
  ASSERT_TRUE(found.has_value());
  const Chain chain = fit_with_series(found->chain, found->parameters, data, tracker, {}).chain;
  const auto value = [&](double q) { return deviations(chain, VectorXd::Constant(6, q))[1]; };
  const double low = data.joints.row(1).minCoeff(), high = data.joints.row(1).maxCoeff();
  std::vector<double> difference;  // up to an offset, which is the joint's
  for (double q = low + 0.2; q < high - 0.2; q += 0.01) difference.push_back(value(q) - bent(q));
  EXPECT_LT(standard_deviation(difference), 0.15 * 4e-4 / std::sqrt(2.0));
  const double opposite = 0.5 * (low + high) + std::numbers::pi;  // farthest from all positions
  EXPECT_LT(std::abs(value(opposite)), 0.02 * 4e-4);
}

TEST(HarmonicSeries, AreNotFoundInNoise) {
  for (int seed = 1; seed <= 10; ++seed) {
    const PoseSet data = bent_readings(nominal_robot(), seed % 2 == 0 ? 60 : 300, {}, seed);
    EXPECT_FALSE(find_series(geometry_of(data), data, tracker).has_value()) << seed;
  }
}

/// The chain's residuals and priors as the fit weighs them: a fit ends where no parameter lowers it.
TEST(HarmonicSeries, TheFitEndsWhereNoParameterLowersTheCost) {
  const PoseSet data = bent_readings(nominal_robot(), 300, {1, 2});
  const auto found = find_series(geometry_of(data), data, tracker);
  ASSERT_TRUE(found.has_value());
  const ParameterSet& set = found->parameters;
  const Estimate fit = fit_with_series(found->chain, set, data, tracker, {});
  ASSERT_TRUE(fit.outliers.empty());
  const Weights weights = weights_of(data, tracker);
  const auto cost = [&](const Chain& chain) {
    VectorXd r;
    pose_residuals(chain, set, data, weights).evaluate(pack(set, chain), r, nullptr);
    return r.squaredNorm();
  };
  expect_least_cost(fit.chain, set, cost);
}

TEST(HarmonicSeries, TheDefaultModelTakesThemWhereTheyExplainMore) {
  const PoseSet data = bent_readings(nominal_robot(), 400, {1, 2});
  const Calibration c = calibrate_robot({nominal_robot(), {}, tracker, data}, {}, Rng(1)).value();
  EXPECT_EQ(joints_with_series(c.estimate.chain), (std::vector{1, 2}));
  const SelectionStep& step = step_with(c, Term::spectral_harmonics);
  EXPECT_TRUE(is_selected(step)) << words::reason(step);
  const PoseSet unseen = bent_readings(nominal_robot(), 200, {1, 2}, 7);
  EXPECT_LT(mean_error(c.estimate.chain, unseen),
            2.0 * mean_error(nominal_robot(), bent_readings(nominal_robot(), 200, {}, 7)));
}

/// A joint's offset and the constant of its series explain the same: neither is known, and the tool is.
TEST(HarmonicSeries, StandardDeviationsOfPredictionsAreThoseOfTheirErrors) {
  for (int seed = 1; seed <= 3; ++seed) {
    const PoseSet data = bent_readings(nominal_robot(), 200, {1, 2}, seed);
    const Calibration c = calibrate_robot({nominal_robot(), {}, tracker, data}, {}, Rng(1)).value();
    ASSERT_FALSE(joints_with_series(c.estimate.chain).empty());
    PoseSet unseen = bent_readings(nominal_robot(), 300, {1, 2}, 20 + seed);
    const Chain chain = corrected_chain(c);
    const auto poses = deploy::predict_poses(chain, unseen, c.prediction).value();
    const auto spread = deploy::predict_uncertainties(chain, *c.prediction, unseen).value();
    double squares = 0.0, expected = 0.0;
    for (const PointMeasurement& point : unseen.points) {
      const auto row = static_cast<std::size_t>(point.row);
      squares += (point.position - poses[row].position).squaredNorm();
      expected += spread[row].position.trace() + 3.0 * std::pow(position_sd(tracker, point.position), 2);
    }
    EXPECT_GT(expected / squares, 0.8 * 0.8) << seed;
    EXPECT_LT(expected / squares, 1.6 * 1.6) << seed;
  }
}

TEST(HarmonicSeries, AreTheSameFor12And7Threads) {
  const PoseSet data = bent_readings(nominal_robot(), 200, {1});
  const CalibrationTask task{nominal_robot(), {}, tracker, data};
  const Calibration one = calibrate_robot(task, {.threads = 1}, Rng(1)).value();
  EXPECT_FALSE(joints_with_series(one.estimate.chain).empty());
  for (const int threads : {2, 7}) {
    const Calibration other = calibrate_robot(task, {.threads = threads}, Rng(1)).value();
    EXPECT_EQ(other.estimate.covariance, one.estimate.covariance);
    for (std::size_t k = 0; k < one.estimate.chain.joints[1].harmonics.size(); ++k)
      EXPECT_EQ(other.estimate.chain.joints[1].harmonics[k].sine, one.estimate.chain.joints[1].harmonics[k].sine);
  }
}

TEST(HarmonicSeries, OfBallBarsAreNotSought) {
  PoseSet data = bent_readings(nominal_robot(), 200, {1});
  const Estimate geometry = geometry_of(data);
  data.pairs.push_back({0, 1, 0.5});
  EXPECT_FALSE(find_series(geometry, data, tracker).has_value());
}

}  // namespace
}  // namespace kinfer
