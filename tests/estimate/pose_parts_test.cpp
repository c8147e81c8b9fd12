// SPDX-License-Identifier: Apache-2.0
// Parts of the fit to poses: correlated errors, whitened points, loads of a row, joint priors, noise levels.
#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/estimate/poses/noise_level.hpp"
#include "kinfer/estimate/poses/point_fit.hpp"
#include "kinfer/estimate/poses/pose_normal_equations.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "support/instruments.hpp"
#include "support/robots.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using test::random_vector;
using Covariance6 = Eigen::Matrix<double, 6, 6>;

Covariance6 random_covariance6(Rng& rng, double scale) {
  Covariance6 root;
  for (double& number : root.reshaped()) number = scale * rng.normal();
  return root * root.transpose();
}

/// A measured pose in row 0 whose six errors have this covariance.
PoseSet correlated_pose(const Covariance6& covariance) {
  const PrincipalDeviations point = principal_deviations(covariance.topLeftCorner<3, 3>()),
                            turn = principal_deviations(covariance.bottomRightCorner<3, 3>());
  PoseSet set;
  set.joints = MatrixXd::Zero(6, 1);
  set.points = {{.row = 0, .target = -1, .position = Vec3::Zero(), .sd = point.sd, .axes = point.axes}};
  set.orientations = {{0, Quat::Identity(), turn.sd, turn.axes, Mat3(covariance.topRightCorner<3, 3>())}};
  return set;
}

TEST(ConditionOn, IsTheMarginalOfTheJointInformation) {
  Rng rng(1);
  for (int k = 0; k < 10; ++k) {
    const Covariance6 covariance = random_covariance6(rng, 1.0), information = *invert_spd(covariance);
    const ConditionalError known{random_vector(rng), covariance.topLeftCorner<3, 3>()},
        error{random_vector(rng), covariance.bottomRightCorner<3, 3>()};
    const ConditionalError given = condition_on(known, error, covariance.bottomLeftCorner<3, 3>());
    const Mat3 expected = information.bottomRightCorner<3, 3>().inverse();
    EXPECT_LT((given.covariance - expected).norm(), 1e-8 * expected.norm());
    const Vec3 mean = error.error + expected * information.bottomLeftCorner<3, 3>() * known.error;
    EXPECT_LT((given.error - mean).norm(), 1e-8 * (1 + mean.norm()));
  }
}

TEST(ConditionOn, NothingCorrelatedChangesNothing) {
  Rng rng(2);
  const ConditionalError known{random_vector(rng), Mat3::Identity()}, error{random_vector(rng), 2.0 * Mat3::Identity()};
  const ConditionalError given = condition_on(known, error, Mat3::Zero());
  EXPECT_EQ(given.error, error.error);
  EXPECT_EQ(given.covariance, error.covariance);
}

TEST(PoseCouplings, WhitenTheSixRowsAndKnowTheirDeterminant) {
  Rng rng(3);
  for (int k = 0; k < 10; ++k) {
    const Covariance6 covariance = random_covariance6(rng, 1e-3);
    const PoseSet set = correlated_pose(covariance);
    const auto couplings = couplings_of(set, {*set.points[0].sd}, {*set.orientations[0].sd});
    ASSERT_EQ(couplings.size(), 1u);
    // Of six errors e: squares of the whitened rows are eᵀ C⁻¹ e.
    Eigen::Matrix<double, 6, 1> e;
    for (double& number : e) number = 1e-3 * rng.normal();
    const Vec3 point = (set.points[0].axes->transpose() * e.head<3>()).cwiseQuotient(*set.points[0].sd);
    Vec3 turn = (set.orientations[0].axes->transpose() * e.tail<3>()).cwiseQuotient(*set.orientations[0].sd);
    couplings[0].whiten(turn, point);
    const double expected = e.dot(*solve_spd(covariance, e));
    EXPECT_NEAR(point.squaredNorm() + turn.squaredNorm(), expected, 1e-6 * expected);
    const double separate =
        covariance.topLeftCorner<3, 3>().determinant() * covariance.bottomRightCorner<3, 3>().determinant();
    const double together = 2.0 * cholesky(covariance)->diagonal().array().log().sum();
    EXPECT_NEAR(couplings[0].log_determinant(), together - std::log(separate), 1e-6);
  }
}

TEST(PoseCouplings, NeedAPointInTheirRowAndACovariance) {
  Rng rng(4);
  PoseSet set = correlated_pose(random_covariance6(rng, 1.0));
  const std::vector<Vec3> sd{Vec3::Ones()};
  EXPECT_EQ(couplings_of(set, {*set.points[0].sd}, {*set.orientations[0].sd}).size(), 1u);
  PoseSet on_target = set, elsewhere = set, independent = set;
  on_target.points[0].target = 0;
  elsewhere.joints = MatrixXd::Zero(6, 2), elsewhere.points[0].row = 1;
  independent.orientations[0].covariance_with_point = std::nullopt;
  for (const PoseSet& other : {on_target, elsewhere, independent}) EXPECT_TRUE(couplings_of(other, sd, sd).empty());
  set.orientations[0].covariance_with_point = 100.0 * Mat3::Identity();  // no covariance of six numbers
  EXPECT_DEATH(couplings_of(set, sd, sd), "row 0 is not positive definite");
}

TEST(Whitening, MapsErrorsToIndependentRowsOfUnitVariance) {
  Rng rng(5);
  PoseSet set;
  set.joints = MatrixXd::Zero(1, 2);
  const Mat3 axes = exp_so3(random_vector(rng));
  set.points = {{.row = 0, .target = -1, .position = Vec3::Zero(), .sd = Vec3(1, 2, 4)},
                {.row = 1, .target = -1, .position = Vec3::Zero(), .sd = Vec3(1, 2, 4)}};
  EXPECT_FALSE(has_full_covariances(set));
  set.points[1].axes = axes;
  EXPECT_TRUE(has_full_covariances(set));
  const Weights weights = weights_of(set, Instrument{});
  const auto matrices = whitening_matrices(set, weights);
  ASSERT_EQ(matrices.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const Mat3 covariance = covariance_of(*set.points[i].sd, set.points[i].axes);
    EXPECT_LT((matrices[i] * covariance * matrices[i].transpose() - Mat3::Identity()).norm(), 1e-13);
  }
  const MatrixXd rows = test::random_matrix(6, 4, 6);
  MatrixXd white = rows;
  whiten(matrices, white);
  EXPECT_LT((white.topRows<3>() - matrices[0] * rows.topRows<3>()).norm(), 1e-14);
  EXPECT_LT((white.bottomRows<3>() - matrices[1] * rows.bottomRows<3>()).norm(), 1e-14);
  EXPECT_LT((inverse_sd(weights).col(1) - Vec3(1, 0.5, 0.25)).norm(), 1e-15);
}

TEST(PointTableOf, HasTheJointPositionsOfEachPointsRow) {
  PoseSet set;
  set.joints = (MatrixXd(2, 3) << 1, 2, 3, 10, 20, 30).finished();
  set.points = {{.row = 2, .target = -1, .position = Vec3(1, 0, 0), .sd = {}},
                {.row = 0, .target = 0, .position = Vec3(0, 1, 0), .sd = {}},
                {.row = 2, .target = 0, .position = Vec3(0, 0, 1), .sd = {}}};
  const PointTable table = point_table(set);
  EXPECT_EQ(table.joints, (MatrixXd(2, 3) << 3, 1, 3, 30, 10, 30).finished());
  EXPECT_EQ(table.measured, Mat3::Identity());
  EXPECT_EQ(table.target, (std::vector<int>{-1, 0, 0}));
  EXPECT_EQ(point_table(PoseSet{}).measured.cols(), 0);
}

TEST(RowLoads, AreThoseOfTheRowAndNothingWhereTheSetHasNone) {
  Chain chain = test::er20();
  chain.reference_temperature = 20.0;
  PoseSet set;
  set.joints = MatrixXd::Zero(6, 2);
  EXPECT_EQ(load_at(chain, set, 1).payload, 0.0);
  EXPECT_EQ(load_at(chain, set, 1).temperature_rise, 0.0);
  EXPECT_TRUE(load_at(chain, set, 1).torques.empty());
  set.payload = {1.0, 5.0}, set.temperature = {std::nan(""), 27.0};
  set.torques = MatrixXd::Constant(6, 2, 3.0), set.torques(4, 1) = 7.0;
  EXPECT_EQ(load_at(chain, set, 1).payload, 5.0);
  EXPECT_EQ(load_at(chain, set, 1).temperature_rise, 7.0);
  EXPECT_EQ(load_at(chain, set, 0).temperature_rise, 0.0) << "not measured";
  EXPECT_EQ(load_at(chain, set, 1).torques[4], 7.0);
}

TEST(RowLoads, GravityTorquesAreThoseOfEachRowInItsMounting) {
  Chain chain = test::er20();
  PoseSet set = test::readings_of(test::measured(chain, test::paper2_poses(4, test::noise_free)));
  EXPECT_EQ(gravity_torques_of_rows(chain, set).size(), 0) << "nothing is heavy";
  set.payload = {0.0, 10.0, 20.0, 20.0};
  chain.mountings = {
      {.name = "wall", .base = Frame::from_pose(Pose::from_xyz_rpy({0, 0, 0}, {1.5, 0, 0})), .tool = chain.tool}};
  set.mounting = {-1, -1, -1, 0};
  const MatrixXd torques = gravity_torques_of_rows(chain, set);
  ASSERT_EQ(torques.cols(), 4);
  EXPECT_EQ(torques.col(0).norm(), 0.0);
  for (int row = 1; row < 4; ++row) {
    const Chain here = with_mounting(chain, set.mounting[row]);
    EXPECT_EQ(torques.col(row), gravity_torques(here, set.joints.col(row), {.payload = set.payload[row]}));
  }
  EXPECT_NEAR(torques(0, 2), 0.0, 1e-9) << "the first axis is upright";
  EXPECT_GT(std::abs(torques(0, 3)), 1.0) << "and lies on its side on a wall";
}

/// A small fit whose joint prior couples two parameters.
struct PriorCase {
  Chain nominal = test::er20();
  PoseSet data = test::measured(test::with_table3_errors(test::er20()), test::paper2_poses(20, test::tracker));
  ParameterSet set = with_only_free(all_parameters(nominal, {}), {"a2", "a3", "d4", "theta2"});
  PriorCase() { set.prior_sqrt_information = 1e4 * (test::random_matrix(4, 4, 3) + 3.0 * MatrixXd::Identity(4, 4)); }
};

TEST(JointPrior, IsTheSameCostByResidualsByKernelsAndByNormalEquations) {
  const PriorCase c;
  const Weights weights = weights_of(c.data, test::tracker);
  const Residuals problem = pose_residuals(c.nominal, c.set, c.data, weights);
  const VectorXd start = pack(c.set, c.nominal), x = start.array() + 3e-5;
  VectorXd r;
  problem.evaluate(x, r, nullptr);
  EXPECT_LT((r.tail(4) - c.set.prior_sqrt_information * (x - start)).norm(), 1e-9 * r.tail(4).norm());
  EXPECT_NEAR(pose_normal_problem(c.nominal, c.set, c.data, weights).cost(x), r.squaredNorm(), 1e-9 * r.squaredNorm());
  const MatrixXd information = c.set.prior_sqrt_information.transpose() * c.set.prior_sqrt_information;
  const MatrixXd added = prior_information(c.set).selfadjointView<Eigen::Lower>();
  EXPECT_LT((added - information).norm(), 1e-12 * information.norm());
  const BatchPoints points(c.nominal, c.set, point_table(c.data));
  const LeastSquaresOutcome fast = fit_points(points, c.set, points.weights(inverse_sd(weights)), start),
                            slow = least_squares(problem, start);
  EXPECT_NEAR(fast.cost, slow.cost, 1e-9 * slow.cost);
  EXPECT_LT((fast.x - slow.x).norm(), 1e-9);
}

TEST(JointPrior, PullsAStrongerPriorCloserToTheNominalValues) {
  PriorCase c;
  const Weights weights = weights_of(c.data, test::tracker);
  const VectorXd start = pack(c.set, c.nominal);
  double before = 1e9;
  for (const double strength : {1e-3, 1.0, 1e3}) {
    ParameterSet set = c.set;
    set.prior_sqrt_information *= strength;
    const VectorXd x = least_squares(pose_residuals(c.nominal, set, c.data, weights), start).x;
    const double pulled = (set.prior_sqrt_information / strength * (x - start)).norm();
    EXPECT_LT(pulled, before);
    before = pulled;
  }
}

TEST(ExcessNoiseOf, IsWhatTheInstrumentDoesNotExplain) {
  const Chain chain = test::er20();
  const PoseSet data =
      test::measured(chain, {.poses = 400, .space = {.lowest = 0.0, .clearance = 0.3}, .instrument = {.sigma = 1e-3}});
  const auto point_sd = [&](const std::optional<Instrument>& instrument) {
    return weights_of(data, instrument, excess_noise(chain, data, instrument, 0.0)).of<PointMeasurement>()[0].x();
  };
  EXPECT_NEAR(point_sd(std::nullopt), 1e-3, 0.1e-3);
  EXPECT_NEAR(point_sd(Instrument{.sigma = 0.3e-3}), 1e-3, 0.1e-3) << "too optimistic a specification";
  EXPECT_NEAR(point_sd(Instrument{.sigma = 2e-3}), 2e-3, 1e-12) << "a specification is never reduced";
}

TEST(ExcessNoiseOf, MakesTheMedianOfTheSquaredNormsThatOfGaussianNoise) {
  const Chain chain = test::er20();
  for (const int poses : {201, 400}) {
    PoseSet data = test::measured(
        chain, {.poses = poses, .space = {.lowest = 0.0, .clearance = 0.3}, .instrument = {.sigma = 1e-3}});
    for (std::size_t i = 0; i < data.points.size(); ++i)
      data.points[i].sd = Vec3(1e-4, 3e-4, 2e-6 * static_cast<double>(i));
    const double excess = excess_noise(chain, data, std::nullopt, 0.0).of[index(kind_of<PointMeasurement>)];
    std::vector<double> norm2;
    for (const PointMeasurement& point : data.points) {
      const Vec3 error = forward(chain, data.joints.col(point.row)).position - point.position;
      const Vec3 variance = point.sd->cwiseAbs2().array() + excess * excess;
      norm2.push_back(error.cwiseAbs2().cwiseQuotient(variance).sum());
    }
    EXPECT_NEAR(median(std::move(norm2)), chi_squared_quantile(0.5, 3), 0.01) << poses << " poses";
  }
}

TEST(ExcessNoiseOf, AMinorityOfOutliersDoesNotCountAndFittedParametersDo) {
  const Chain chain = test::er20();
  PoseSet data =
      test::measured(chain, {.poses = 400, .space = {.lowest = 0.0, .clearance = 0.3}, .instrument = {.sigma = 1e-3}});
  const auto sd_of = [&](double parameters) {
    return weights_of(data, std::nullopt, excess_noise(chain, data, std::nullopt, parameters))
        .of<PointMeasurement>()[0]
        .x();
  };
  const double all = sd_of(0.0);
  EXPECT_NEAR(sd_of(300.0) / all, std::sqrt(4.0 / 3.0), 1e-6) << "300 of 1200 rows are absorbed";
  for (std::size_t i = 0; i < data.points.size(); i += 10) data.points[i].position.x() += 1.0;
  EXPECT_NEAR(sd_of(0.0), all, 0.15 * all);
}

}  // namespace
}  // namespace kinfer
