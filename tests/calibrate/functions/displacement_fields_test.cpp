// SPDX-License-Identifier: Apache-2.0
// Displacements of the tool that are smooth functions of all joint positions.
#include "kinfer/calibrate/functions/displacement_fields.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibrate/functions/nominal_fits.hpp"
#include "calibrate/terms/simulated_selection.hpp"
#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/functions/field_problem.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/terms/holdout_errors.hpp"
#include "kinfer/estimate/poses/noise_level.hpp"
#include "kinfer/estimate/poses/pose_normal_equations.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/words/calibration/model.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

/// [m] along the axes of the base: bearings and links that yield in all postures differently.
Vec3 yielding(const VectorXd& q) {
  return 2e-4 * Vec3(std::sin(q[0] + q[1]), std::cos(q[1] - 2.0 * q[2]), std::sin(q[2]) * std::cos(q[0]));
}

/// Points of a robot whose tool is displaced so.
PoseSet displaced_readings(const Chain& truth, int poses, int seed = 1) {
  PoseSet data = simulated_readings(truth, poses, seed);
  measure_points(data, truth, tracker, Rng(seed + 50));
  for (PointMeasurement& point : data.points) point.position += yielding(data.joints.col(point.row));
  return data;
}

PoseSet rigid_readings(const Chain& truth, int poses, int seed) {
  PoseSet data = simulated_readings(truth, poses, seed);
  measure_points(data, truth, tracker, Rng(seed + 50));
  return data;
}

Calibration calibrated(const PoseSet& data, int threads = 2) {
  return calibrate_robot({nominal_robot(), {}, tracker, data}, {.threads = threads}, Rng(1)).value();
}

TEST(DisplacementFields, AreFoundWhereTheToolIsDisplaced) {
  const PoseSet data = displaced_readings(nominal_robot(), 200);
  const Estimate geometry = geometry_of(data);
  const FoundField found = find_field(geometry, data, tracker);
  EXPECT_GT(found.log_evidence_gain, 20.0);
  EXPECT_GT(found.determined, 20);
  EXPECT_LE(found.determined, found.values);
  const Estimate fit = fit_with_field(found.chain, geometry.parameters, data, tracker, {});
  const PoseSet unseen = displaced_readings(nominal_robot(), 200, 7);
  EXPECT_LT(mean_error(fit.chain, unseen), 0.6 * mean_error(geometry.chain, unseen));
}

TEST(DisplacementFields, AreNotFoundInNoise) {
  for (int seed = 1; seed <= 20; ++seed) {
    const PoseSet data = rigid_readings(nominal_robot(), seed % 2 == 0 ? 40 : 150, seed);
    EXPECT_LT(find_field(geometry_of(data), data, tracker).log_evidence_gain, 0.0) << seed;
  }
}

// Beside orientations that are as good as stated, better, and exact.
TEST(DisplacementFields, AreNotFoundInPosesWhateverTheNoiseOfTheirOrientations) {
  int seed = 0;
  for (const double better : {1.0, 1.2, 1.5, 3.0, 10.0, 1e9})
    for (const int poses : {40, 80}) {
      ++seed;
      Instrument instrument = tracker;
      instrument.sigma_angle = 1e-4 / better;
      PoseSimulation simulation = paper2_poses(poses, instrument);
      simulation.measured = Measured::poses;
      const PoseSet data = measured(with_random_errors(nominal_robot(), {}, Rng(seed)), simulation, seed);
      ASSERT_FALSE(data.orientations.empty());
      instrument.sigma_angle = 1e-4;
      const auto stated = seed % 3 == 0 ? std::nullopt : std::optional(instrument);
      const Calibration c = calibrate_robot({nominal_robot(), {}, stated, data}, {.threads = 2}, Rng(1)).value();
      EXPECT_TRUE(c.estimate.chain.field.empty())
          << better << " " << poses << ": " << words::reason(step_with(c, Term::displacement_field));
    }
}

/// Whether one of the field's inducing points is at the joint positions of one of these rows.
bool has_seen(const DisplacementField& field, const PoseSet& data, const std::vector<int>& rows) {
  return std::ranges::any_of(rows, [&](int row) {
    return (field.points.colwise() - data.joints.col(row)).colwise().norm().minCoeff() < 1e-9;
  });
}

TEST(DisplacementFields, OfHeldOutRowsHaveNotSeenTheseHoweverFewTheOthersAre) {
  const PoseSet data = displaced_readings(nominal_robot(), 24);
  const Estimate geometry = geometry_of(data);
  const Estimate fit =
      fit_with_field(find_field(geometry, data, tracker).chain, geometry.parameters, data, tracker, {});
  std::vector<Split> splits(3);
  for (int row = 0; row < 24; ++row)
    for (int k = 0; k < 3; ++k) (row % 3 == k ? splits[k].holdout : splits[k].train).push_back(row);
  const CalibrationTask task{nominal_robot(), {}, tracker, data};
  const HoldoutErrors held_out = cross_validate(fit, geometry.parameters, data, splits, task, 1);
  for (int k = 0; k < 3; ++k) {
    const DisplacementField& field = held_out.split_fits[k].chain.field;
    EXPECT_FALSE(field.empty());
    EXPECT_FALSE(has_seen(field, data, splits[k].holdout)) << k;
  }
}

/// That of an earlier calibration has seen none of the rows, and few of them are no reason to give it up.
TEST(DisplacementFields, OfAnEarlierCalibrationAreKeptWhereRowsAreFew) {
  const PoseSet many = displaced_readings(nominal_robot(), 100);
  const Estimate geometry = geometry_of(many);
  const Chain earlier = find_field(geometry, many, tracker).chain;
  const PoseSet few = displaced_readings(nominal_robot(), 10, 9);
  const CalibrationTask task{earlier, {}, tracker, few};
  const Estimate fit = fit_rows(earlier, joint_offset_parameters(earlier, few, {}), few, task, {});
  EXPECT_EQ(fit.chain.field.coefficients, earlier.field.coefficients);
}

/// Four wires hold a point, wherever the base stands.
Chain robot_with_wires() {
  Chain chain = nominal_robot();
  chain.base = Frame::from_pose(Pose::from_xyz_rpy({0.3, -0.2, 0.1}, {0.02, -0.03, 1.3}));
  chain.fixtures.anchors = {{2.0, 1.5, 0.1}, {2.0, -1.5, 0.2}, {-1.5, 0.3, 2.2}, {0.4, 0.2, -1.5}};
  return chain;
}

PoseSet wire_readings(const Chain& truth, int poses, int seed) {
  PoseSet data = simulated_readings(truth, poses, seed);
  measure_distances(data, truth, tracker.sigma, Rng(seed + 50));
  return data;
}

/// Of a robot whose tool is displaced.
PoseSet displaced_wire_readings(const Chain& truth, int poses, int seed) {
  PoseSet data = wire_readings(truth, poses, seed);
  const std::vector<Pose> at = true_poses(truth, data);
  const Pose base = truth.base.pose();
  for (DistanceMeasurement& wire : data.distances) {
    const Vec3 from = at[wire.row].position - base * truth.fixtures.anchors[wire.anchor],
               to = from + base.rotation * yielding(data.joints.col(wire.row));
    wire.distance += to.norm() - from.norm();
  }
  return data;
}

Estimate geometry_by_wires(const Chain& chain, const PoseSet& data) {
  return fit_bundle(chain, geometric_parameters(chain, data, {}), data, tracker);
}

TEST(DisplacementFields, AreFoundByDrawWires) {
  const Chain chain = robot_with_wires();
  const PoseSet data = displaced_wire_readings(chain, 150, 1), unseen = displaced_wire_readings(chain, 100, 7);
  const Estimate geometry = geometry_by_wires(chain, data);
  const FoundField found = find_field(geometry, data, tracker);
  EXPECT_GT(found.log_evidence_gain, 20.0);
  const Estimate fit = fit_with_field(found.chain, geometry.parameters, data, tracker, {});
  const auto error = [&](const Chain& of) { return mean(residual_norms(kind_of<DistanceMeasurement>, of, unseen)); };
  EXPECT_LT(error(fit.chain), 0.7 * error(geometry.chain));
}

TEST(DisplacementFields, AreNotFoundInTheNoiseOfDrawWires) {
  const Chain chain = robot_with_wires();
  for (int seed = 1; seed <= 10; ++seed) {
    const PoseSet data = wire_readings(chain, seed % 2 == 0 ? 40 : 100, seed);
    EXPECT_LT(find_field(geometry_by_wires(chain, data), data, tracker).log_evidence_gain, 0.0) << seed;
  }
}

/// A small problem, and the same by matrices of all its residuals.
struct DenseField : ::testing::Test {
  PoseSet data = displaced_readings(nominal_robot(), 40);
  Estimate geometry = geometry_of(data);
  Weights weights = weights_of(data, tracker);
  Chain chain = find_field(geometry, data, tracker).chain;
  const ParameterSet& set = geometry.parameters;
  FieldProblem problem{chain, set, {data, weights}};

  /// Covariance of the displacements of all rows for a size of 1: that of the inducing points carried over.
  MatrixXd covariance_of_rows() const {
    const DisplacementField& field = chain.field;
    MatrixXd among(field.points.cols(), field.points.cols()), across(field.points.cols(), data.rows());
    for (Eigen::Index k = 0; k < among.cols(); ++k) among.col(k) = kernel_at(field, field.points.col(k));
    for (Eigen::Index i = 0; i < across.cols(); ++i) across.col(i) = kernel_at(field, data.joints.col(i));
    return across.transpose() * solve_semidefinite(among, across);
  }

  /// Of the residuals: three a row, along the axes of the base, which here are the world's.
  MatrixXd covariance_of_residuals(double size) const {
    const MatrixXd rows = covariance_of_rows();
    MatrixXd all = MatrixXd::Identity(3 * data.rows(), 3 * data.rows());
    const Mat3 turn = chain.base.pose().rotation;
    EXPECT_LT((turn - Mat3::Identity()).norm(), 1e-2);
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      for (Eigen::Index k = 0; k < rows.cols(); ++k)
        for (int c = 0; c < 3; ++c)
          all(3 * i + c, 3 * k + c) += size * size * rows(i, k) /
                                       (weights.of<PointMeasurement>()[static_cast<std::size_t>(i)][c] *
                                        weights.of<PointMeasurement>()[static_cast<std::size_t>(k)][c]);
    return all;
  }

  struct Linear {
    VectorXd r;
    MatrixXd jacobian;
  };
  Linear linear() const {
    Chain plain = chain;
    plain.field = {};
    VectorXd r;
    MatrixXd jacobian;
    pose_residuals(plain, set, data, weights).evaluate(pack(set, plain), r, &jacobian);
    return {r.head(3 * data.rows()), jacobian.topRows(3 * data.rows())};
  }
};

TEST_F(DenseField, TheVariancesOfTheParametersAreThoseBesideACorrelatedNoise) {
  constexpr double size = 1.5e-4;
  const MatrixXd expected =
      *invert_spd(linear().jacobian.transpose() * solve_semidefinite(covariance_of_residuals(size), linear().jacobian) +
                  prior_information(set).selfadjointView<Eigen::Lower>().toDenseMatrix());
  const VectorXd found = problem.solve(size, 1.0).marginal_variances;
  for (Eigen::Index k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k] / expected(k, k), 1.0, 1e-3) << k;
}

TEST_F(DenseField, TheEvidenceIsTheDensityOfTheResiduals) {
  const auto& [r, jacobian] = linear();
  const MatrixXd prior = prior_information(set).selfadjointView<Eigen::Lower>().toDenseMatrix();
  const VectorXd offset = pack(set, chain) - nominal_of(set);
  // Residuals with the parameters integrated over their prior, whose mean lies `offset` away.
  const VectorXd centred = r - jacobian * offset;
  const MatrixXd by_parameters = jacobian * *invert_spd(prior) * jacobian.transpose();
  const auto density = [&](double size) {
    const MatrixXd covariance = covariance_of_residuals(size) + by_parameters;
    return -0.5 * centred.dot(*solve_spd(covariance, centred)) - cholesky(covariance)->diagonal().array().log().sum();
  };
  const FieldProblem::Spectrum spectrum = problem.spectrum();
  const double none = problem.log_evidence(spectrum, 0.0, 1.0);
  for (const double size : {2e-5, 1e-4, 5e-4}) {
    const double expected = density(size) - density(0.0);
    EXPECT_NEAR(problem.log_evidence(spectrum, size, 1.0) - none, expected, 1e-3 * std::abs(expected) + 1e-3) << size;
  }
}

/// Cost of residuals, of the parameters' priors, and of the field: coefficientsᵀ K coefficients / size².
TEST(DisplacementFields, TheFitEndsWhereNothingLowersTheCost) {
  const PoseSet data = displaced_readings(nominal_robot(), 100);
  const Estimate geometry = geometry_of(data);
  const FoundField found = find_field(geometry, data, tracker);
  const ParameterSet& set = geometry.parameters;
  const Estimate fit = fit_with_field(found.chain, set, data, tracker, {});
  ASSERT_TRUE(fit.outliers.empty());
  const Weights weights =
      weights_of(data, tracker, excess_noise(fit.chain, data, tracker, static_cast<double>(found.determined)));
  const DisplacementField& field = fit.chain.field;
  MatrixXd covariance(field.points.cols(), field.points.cols());
  for (Eigen::Index k = 0; k < covariance.cols(); ++k) covariance.col(k) = kernel_at(field, field.points.col(k));
  const auto cost = [&](const Chain& chain) {
    VectorXd r;
    pose_residuals(chain, set, data, weights).evaluate(pack(set, chain), r, nullptr);
    return r.squaredNorm() + (chain.field.coefficients * covariance * chain.field.coefficients.transpose()).trace() /
                                 (field.size * field.size);
  };
  const double least = cost(fit.chain);
  expect_least_cost(fit.chain, set, cost);
  for (Eigen::Index k = 0; k < field.points.cols(); k += 9)
    for (const double by : {-2e-5, 2e-5}) {
      Chain other = fit.chain;
      other.field.coefficients(k % 3, k) += by;
      EXPECT_GT(cost(other), least - 0.1) << k;
    }
}

TEST(DisplacementFields, TheDefaultModelTakesThem) {
  const PoseSet data = displaced_readings(nominal_robot(), 200);
  const Calibration c = calibrated(data);
  const SelectionStep& step = step_with(c, Term::displacement_field);
  EXPECT_EQ(step.decision, Decision::accepted) << words::reason(step);
  EXPECT_FALSE(c.estimate.chain.field.empty());
  EXPECT_GT(step.contribution, 5e-5);
  const PoseSet unseen = displaced_readings(nominal_robot(), 200, 7);
  EXPECT_LT(mean_error(c.estimate.chain, unseen), 0.6 * mean_error(geometry_of(data).chain, unseen));
  ASSERT_TRUE(c.prediction.has_value());
  EXPECT_GT(c.prediction->beyond.size(), 0);  // far from the rows the model without the field holds
}

TEST(DisplacementFields, OfARigidRobotAreRefused) {
  const Calibration c = calibrated(rigid_readings(with_random_errors(nominal_robot(), {}, Rng(4)), 100, 3));
  EXPECT_EQ(step_with(c, Term::displacement_field).decision, Decision::no_evidence);
  EXPECT_TRUE(c.estimate.chain.field.empty());
}

TEST(DisplacementFields, AreFittedWhereTheyAreAskedFor) {
  const PoseSet data = displaced_readings(nominal_robot(), 80);
  const auto c = calibrate_robot({nominal_robot(), {}, tracker, data},
                                 {.model = parse_model_choice("gear+field").value(), .threads = 2}, Rng(1));
  ASSERT_TRUE(c.has_value());
  EXPECT_EQ(selected_model(c->model_selection), "geometry + gear + field");
  EXPECT_FALSE(c->estimate.chain.field.empty());
}

TEST(DisplacementFields, FollowTheBaseOfEachSetUp) {
  Chain truth = nominal_robot();
  truth.mountings = {
      {.name = "second", .base = Frame::from_pose(Pose::from_xyz_rpy({2, 1, 0}, {0, 0.1, 1.5})), .tool = truth.tool}};
  const auto readings = [&](int seed) {
    PoseSet data = simulated_readings(nominal_robot(), 120, seed);
    for (int row = 0; row < 120; ++row) data.mounting.push_back(row % 2 == 0 ? -1 : 0);
    measure_points(data, truth, tracker, Rng(seed + 50));
    for (PointMeasurement& point : data.points)
      point.position += with_mounting(truth, data.mounting[static_cast<std::size_t>(point.row)]).base.pose().rotation *
                        yielding(data.joints.col(point.row));
    return data;
  };
  const PoseSet data = readings(1), unseen = readings(7);
  const Estimate geometry = fit_bundle(truth, geometric_parameters(truth, data, {}), data, tracker);
  const FoundField found = find_field(geometry, data, tracker);
  const Estimate fit = fit_with_field(found.chain, geometry.parameters, data, tracker, {});
  EXPECT_GT(found.log_evidence_gain, 20.0);
  EXPECT_LT(mean_error(fit.chain, unseen), 0.75 * mean_error(geometry.chain, unseen));
}

TEST(DisplacementFields, OnePoseRepeatedDoesNoHarm) {
  PoseSet data = rigid_readings(nominal_robot(), 60, 1);
  for (Eigen::Index row = 10; row < data.joints.cols(); ++row) data.joints.col(row) = data.joints.col(9);
  measure_points(data, nominal_robot(), tracker, Rng(3));
  const Calibration c = calibrated(data);
  EXPECT_TRUE(c.estimate.chain.field.empty());
}

TEST(DisplacementFields, OfBallBarsAndOfFewRowsAreNotSought) {
  PoseSet data = rigid_readings(nominal_robot(), 40, 1);
  EXPECT_TRUE(allows_field(data));
  data.pairs.push_back({0, 1, 0.5});
  EXPECT_FALSE(allows_field(data));
  EXPECT_FALSE(allows_field(rigid_readings(nominal_robot(), 15, 1)));
}

TEST(DisplacementFields, AreTheSameFor12And7Threads) {
  const PoseSet data = displaced_readings(nominal_robot(), 80);
  const Calibration one = calibrated(data, 1);
  ASSERT_FALSE(one.estimate.chain.field.empty());
  for (const int threads : {2, 7}) {
    const Calibration other = calibrated(data, threads);
    EXPECT_EQ(other.estimate.chain.field.coefficients, one.estimate.chain.field.coefficients);
    EXPECT_EQ(other.estimate.covariance, one.estimate.covariance);
  }
}

}  // namespace
}  // namespace kinfer
