// SPDX-License-Identifier: Apache-2.0
// Laws of the unknowns of a continuous-time fit: their order, their increments and their priors.
#include "kinfer/estimate/continuous/model/problem.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/model/bias_process.hpp"
#include "kinfer/estimate/continuous/model/retraction.hpp"
#include "kinfer/estimate/continuous/solver/fact_residuals.hpp"
#include "kinfer/estimate/continuous/solver/spline_prior.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using test::random_vector;

/// A root at rest or in motion, a revolute, a prismatic and a spherical joint, and every kind of unknown.
struct WholeProblem {
  InsProblem problem;
  InsUnknowns x;
  InsLayout layout;

  explicit WholeProblem(bool root_at_rest) {
    Rng rng(6);
    const auto any_rotation = [&] { return exp_so3(random_vector(rng)); };
    problem.grid = {.begin = 0.0, .period = 0.1, .intervals = 200};
    problem.root_at_rest = root_at_rest;
    problem.sensors.resize(4);
    problem.prior = {0.1, 0.2, 0.01, 0.02, 0.004, 1e-4, 0.05};
    problem.bias_process = {.rate_sd = 0.3, .force_sd = 0.2, .time = 10.0};
    problem.facts.places = {{.body = 3, .start = Vec3(0.1, 0.2, 0.3), .sd = 0.5}};
    problem.facts.touches = {{{InsPoint::Kind::place, 3, 0}, {0.5, 1.5}, 0.01}};
    problem.facts.surveyed = {{{InsPoint::Kind::sensor, 1}, 0.3, Vec3(1, 2, 3), 0.01}};
    x.bodies = {{.sensor = 0},
                test::random_revolute_body(0, 1, rng),
                test::random_prismatic_body(1, 2, rng),
                spherical_body(2, 3, any_rotation())};
    x.root_force = random_vector(rng);
    x.errors.resize(4);
    for (InsErrors& errors : x.errors) {
      errors.gyroscope_bias = random_vector(rng);
      errors.accelerometer_scale = random_vector(rng).asDiagonal();
      errors.clock = {.offset = 0.01 * rng.normal(), .drift = 1e-4 * rng.normal()};
    }
    x.facts = {{random_vector(rng)}, {random_vector(rng)}, {}, {any_rotation(), random_vector(rng)}};
    layout = layout_of(problem, x.bodies);
    x.spline_coefficients = test::random_matrix(layout.spline_dimensions, problem.grid.coefficients(), 2);
    x.bias_process = test::random_matrix(layout.bias_process, 3, 3);
  }

  InsStep no_step() const {
    return {0.0 * x.spline_coefficients, VectorXd::Zero(layout.global_parameters), 0.0 * x.bias_process};
  }
  InsUnknowns after(Index unknown, double by) const {
    InsStep step = no_step();
    step.border[unknown] = by;
    return retract(problem, layout, x, step);
  }
};

TEST(InsLayoutOf, EveryGlobalParameterBelongsToExactlyOnePart) {
  for (const bool root_at_rest : {true, false}) {
    const WholeProblem w(root_at_rest);
    VectorXd owners = VectorXd::Zero(w.layout.global_parameters);
    const auto claim = [&](Index first, Index count) {
      if (first >= 0) owners.segment(first, count).array() += 1.0;
    };
    claim(w.layout.root_force, 3);
    for (std::size_t b = 0; b < 4; ++b) claim(w.layout.body[b], w.x.bodies[b].unknowns());
    for (const Index first : w.layout.error) claim(first, w.layout.errors_each);
    claim(w.layout.facts, 3 + 3 + 6);
    EXPECT_EQ(owners, VectorXd::Ones(owners.size()));
    EXPECT_EQ(w.layout.spline_dimensions, (root_at_rest ? 0 : 6) + 1 + 1 + 3);
    EXPECT_EQ(w.layout.bias_process, 6 * 4);
  }
}

TEST(InsLayoutOf, WhatHasNoPriorIsNotEstimated) {
  WholeProblem w(true);
  w.problem.prior = {.gyroscope_bias = 0.1, .accelerometer_bias = 0.1};
  w.problem.bias_process = {};
  w.problem.facts = {};
  const InsLayout layout = layout_of(w.problem, w.x.bodies);
  EXPECT_FALSE(layout.has_matrices || layout.has_clocks || layout.has_tilts);
  EXPECT_EQ(layout.errors_each, 6);
  EXPECT_EQ(layout.clock_error, -1);
  EXPECT_EQ(layout.tilt_error, -1);
  EXPECT_EQ(layout.bias_process, 0);
  EXPECT_EQ(layout.facts, layout.global_parameters);
}

TEST(InsRetract, NoStepChangesNothing) {
  for (const bool root_at_rest : {true, false}) {
    const WholeProblem w(root_at_rest);
    const InsUnknowns same = retract(w.problem, w.layout, w.x, w.no_step());
    EXPECT_EQ(same.spline_coefficients, w.x.spline_coefficients);
    EXPECT_EQ(same.bias_process, w.x.bias_process);
    EXPECT_EQ(same.root_force, w.x.root_force);
    EXPECT_EQ(same.errors[2].accelerometer_scale, w.x.errors[2].accelerometer_scale);
    EXPECT_LT((same.bodies[1].child_R_axis - w.x.bodies[1].child_R_axis).norm(), 1e-15);
    EXPECT_LT((same.facts.surveyor.rotation - w.x.facts.surveyor.rotation).norm(), 1e-15);
  }
}

TEST(InsRetract, RotationsStayRotations) {
  const WholeProblem w(false);
  InsStep step = w.no_step();
  step.border.setConstant(0.7);
  const InsUnknowns far = retract(w.problem, w.layout, w.x, step);
  for (const InsBody& body : far.bodies)
    for (const Mat3& r : {body.parent_R_axis, body.child_R_axis})
      EXPECT_LT((r.transpose() * r - Mat3::Identity()).norm(), 1e-13);
  EXPECT_LT((far.facts.surveyor.rotation.transpose() * far.facts.surveyor.rotation - Mat3::Identity()).norm(), 1e-13);
  EXPECT_LT((far.facts.places[0] - w.x.facts.places[0] - Vec3::Constant(0.7)).norm(), 1e-15);
  EXPECT_NEAR(far.errors[3].clock.offset, w.x.errors[3].clock.offset + 0.7, 1e-15);
}

TEST(InsPrior, GradientOfEveryGlobalParameterAgreesWithDifferences) {
  for (const bool root_at_rest : {true, false}) {
    WholeProblem w(root_at_rest);
    w.problem.common = {.gyroscope = {1.0, 0.02}, .accelerometer = {1.0, 0.01}};
    w.x.errors[0].clock = {};  // the reference is held, far too stiff for differences
    const GlobalParameterPrior prior = global_parameter_prior(w.problem, w.layout, w.x);
    const Index reference = w.layout.error[0] + w.layout.clock_error;
    for (Index k = 0; k < w.layout.global_parameters; ++k) {
      if (k == reference || k == reference + 1) continue;
      constexpr double h = 1e-6;
      const double slope = (global_parameter_prior(w.problem, w.layout, w.after(k, h)).cost -
                            global_parameter_prior(w.problem, w.layout, w.after(k, -h)).cost) /
                           (2 * h);
      EXPECT_NEAR(-2.0 * prior.right[k], slope, 1e-5 * std::max(1.0, std::abs(slope))) << k;
    }
    EXPECT_GE(symmetric_eigen(prior.matrix).values[0], -1e-6);
    EXPECT_GT(prior.cost, 0.0);
  }
}

TEST(InsPrior, ACommonScaleCostsLittleAndOthersAsMuchAsBefore) {
  WholeProblem w(true);
  for (InsErrors& errors : w.x.errors) errors.clock = {};  // the reference is held, and would hide all else
  const auto cost = [&](double own, double sd) {
    w.problem.common = {.gyroscope = {}, .accelerometer = {1.0, sd}};
    for (std::size_t s = 0; s < w.x.errors.size(); ++s)
      w.x.errors[s].accelerometer_scale = (0.05 + (s % 2 == 0 ? own : -own)) * Mat3::Identity();
    return global_parameter_prior(w.problem, w.layout, w.x).cost;
  };
  const double wide = 10.0, prior = w.problem.prior.accelerometer_scale;
  const double sensors = static_cast<double>(w.x.errors.size());
  EXPECT_NEAR(cost(0.01, wide) - cost(0.0, wide), 3.0 * sensors * 1e-4 / (prior * prior), 1e-3) << "their difference";
  // Of the covariance prior² I + sd² 1 1ᵀ along 1, of 3 n elements.
  const double narrow = 0.03, n = 3.0 * sensors,
               saved = n * 0.0025 / (prior * prior) - n * 0.0025 / (prior * prior + n * narrow * narrow);
  EXPECT_NEAR(cost(0.0, 0.0) - cost(0.0, narrow), saved, 1e-6 * saved);
}

TEST(InsPrior, IsNothingWhereAllIsAsExpected) {
  WholeProblem w(true);
  w.x.root_force = Vec3(0, 0, w.problem.gravity);
  w.x.errors.assign(4, {});
  w.x.facts.places[0] = w.problem.facts.places[0].start;
  for (InsBody& body : w.x.bodies) body.point_in_parent = body.point_in_child = Vec3::Zero();
  EXPECT_NEAR(global_parameter_prior(w.problem, w.layout, w.x).cost, 0.0, 1e-20);
  w.x.root_force *= 1.01;
  const double excess = 0.01 * w.problem.gravity / w.problem.gravity_sd;
  EXPECT_NEAR(global_parameter_prior(w.problem, w.layout, w.x).cost, excess * excess, 1e-9);
}

TEST(BiasProcessCost, IsThatOfTheProcessCovarianceInverted) {
  const WholeProblem w(true);
  const Index w_each = w.layout.bias_process, segments = w.x.bias_process.cols();
  double expected = 0.0;
  for (Index k = 0; k < w_each; ++k) {
    const double sd = k % 6 < 3 ? 0.3 : 0.2;
    const MatrixXd covariance = MatrixXd::NullaryExpr(segments, segments, [&](Index i, Index j) {
      return sd * sd * std::exp(-6.4 * std::abs(static_cast<double>(i - j)) / 10.0);
    });
    const VectorXd row = w.x.bias_process.row(k).transpose();
    expected += row.dot(*solve_spd(covariance, row));
  }
  EXPECT_NEAR(bias_process_cost(w.problem, w.layout, w.x), expected, 1e-9 * expected);
}

TEST(BiasProcessCost, OfConstantBiasesIsZeroAndOneThatDoesNotVaryIsHeld) {
  WholeProblem w(true);
  w.problem.bias_process = {};
  EXPECT_EQ(bias_process_cost(w.problem, layout_of(w.problem, w.x.bodies), w.x), 0.0);
  w.problem.bias_process = {.rate_sd = 0.0, .force_sd = 0.2, .time = 10.0};
  const BiasProcessPrior prior = bias_process_prior(w.problem, layout_of(w.problem, w.x.bodies));
  EXPECT_NEAR(prior.decay, std::exp(-0.64), 1e-15);
  EXPECT_GT(prior.information[0], 1e15);
  EXPECT_NEAR(prior.information[3], 25.0, 1e-12);
  EXPECT_NEAR(prior.innovation[3], 25.0 / (1.0 - std::exp(-1.28)), 1e-12);
}

TEST(BiasProcessCost, ErrorsOfAnIntervalAreTheConstantsPlusThoseOfItsSegment) {
  const WholeProblem w(true);
  for (const Index interval : {0, 63, 64, 199}) {
    const InsErrors errors = errors_at(w.problem, w.x, 2, interval);
    const VectorXd deviation = w.x.bias_process.col(interval < 64 ? 0 : interval < 128 ? 1 : 2).segment<6>(12);
    EXPECT_EQ(errors.gyroscope_bias, Vec3(w.x.errors[2].gyroscope_bias + deviation.head<3>()));
    EXPECT_EQ(errors.accelerometer_bias, Vec3(w.x.errors[2].accelerometer_bias + deviation.tail<3>()));
  }
  EXPECT_EQ(bias_parameters(w.layout).size(), 24u);
  EXPECT_EQ(bias_parameters(w.layout)[6], w.layout.error[1]);
}

TEST(SplinePrior, VisitsEveryThirdDifferenceOnceAndTheStartOfEveryJoint) {
  for (const bool root_at_rest : {true, false}) {
    WholeProblem w(root_at_rest);
    w.problem.anchor = {0.5, 0.0, 0.0, 0.0, 0.0};
    MatrixXd differences = MatrixXd::Zero(w.layout.spline_dimensions, w.problem.grid.coefficients() - 3);
    int anchors = 0;
    for (Index interval = 0; interval < w.problem.grid.intervals; ++interval)
      each_spline_prior(w.problem, w.layout, w.x.spline_coefficients, interval, [&](const SplinePriorTerm& term) {
        if (term.weights[0] == 1.0) {
          const Index joint = term.spline_dimension - (root_at_rest ? 0 : 6);
          ASSERT_EQ(interval, 0);
          EXPECT_EQ(term.value, w.x.spline_coefficients(term.spline_dimension, 0) - (joint == 0 ? 0.5 : 0.0));
          ++anchors;
          return;
        }
        Index first = 0;
        while (term.weights[first] == 0.0) ++first;
        const auto c = w.x.spline_coefficients.row(term.spline_dimension).segment<4>(interval + first);
        const double third = c[3] - 3 * c[2] + 3 * c[1] - c[0];
        EXPECT_NEAR(std::abs(term.value), std::abs(third), 1e-12);
        differences(term.spline_dimension, interval + first) += 1.0;
        EXPECT_GT(term.sd, 0.0);
      });
    EXPECT_EQ(anchors, 5);
    EXPECT_EQ(differences, MatrixXd::Ones(differences.rows(), differences.cols()));
  }
}

/// One block with measurements in each of these intervals.
std::vector<InsBlock> blocks_in(Index intervals, Index begin, Index end) {
  std::vector<InsBlock> blocks(static_cast<std::size_t>(intervals));
  for (Index k = begin; k < end; ++k) blocks[static_cast<std::size_t>(k)].rows = 4;
  return blocks;
}

TEST(MeasuredSpan, OfAJointIsThatOfItsSensorAndThoseBeyondAndOfTheRootThatOfAll) {
  WholeProblem w(false);
  w.problem.sensors[0].angular_velocity = blocks_in(200, 20, 150);
  w.problem.sensors[1].force = blocks_in(200, 10, 30);
  w.problem.sensors[2].angular_velocity = blocks_in(200, 50, 60);
  w.problem.sensors[3].angular_velocity = blocks_in(200, 55, 180);
  const InsLayout layout = layout_of(w.problem, w.x.bodies);
  const auto span_of = [&](std::size_t dimension) {
    return std::pair(layout.measured[dimension].begin, layout.measured[dimension].end);
  };
  EXPECT_EQ(span_of(0), std::pair(Index{10}, Index{180})) << "the root";
  EXPECT_EQ(span_of(6), std::pair(Index{10}, Index{180})) << "the revolute joint carries the others";
  EXPECT_EQ(span_of(7), std::pair(Index{50}, Index{180}));
  for (const std::size_t spherical : {8u, 9u, 10u}) EXPECT_EQ(span_of(spherical), std::pair(Index{55}, Index{180}));
}

TEST(SplinePrior, BeforeTheFirstMeasurementAndAfterTheLastASplineStaysNearItself) {
  WholeProblem w(true);
  for (InsMeasurements& sensor : w.problem.sensors) sensor.angular_velocity = blocks_in(200, 150, 190);
  const InsLayout layout = layout_of(w.problem, w.x.bodies);
  Index steps = 0;
  MatrixXd normal = MatrixXd::Zero(205, 205);
  for (Index interval = 0; interval < 200; ++interval)
    each_spline_prior(w.problem, layout, w.x.spline_coefficients, interval, [&](const SplinePriorTerm& term) {
      if (term.spline_dimension != 0) return;
      normal.block<6, 6>(interval, interval) += term.weights * term.weights.transpose() / (term.sd * term.sd);
      Index first = 0;
      while (term.weights[first] == 0.0) ++first;
      if (term.weights[first] != -1.0 || term.weights[first + 1] != 1.0) return;
      ++steps;
      const Index at = interval + first;
      EXPECT_TRUE(at < 152 || at > 191) << at;
      EXPECT_NEAR(term.value, w.x.spline_coefficients(0, at + 1) - w.x.spline_coefficients(0, at), 1e-12);
    });
  EXPECT_EQ(steps, 152 + 12);
  for (Index k = 152; k < 192; ++k) normal(k, k) += 1e6;  // measured
  const auto covariance = invert_spd(normal);
  ASSERT_TRUE(covariance) << "third differences alone leave no numerical inverse";
  EXPECT_LT(std::sqrt((*covariance)(0, 0)), 10.0 * 15.0) << "15 s at 10 rad/s";
}

TEST(FactCost, OfATapeIsItsSquaredErrorInStandardDeviations) {
  InsProblem problem;
  problem.grid = {.begin = 0.0, .period = 0.1, .intervals = 10};
  problem.sensors.resize(2);
  problem.facts.tapes = {{{InsPoint::Kind::sensor, 0}, {InsPoint::Kind::sensor, 1}, 0.6, 0.01, 0.5}};
  InsUnknowns x;
  const Mat3 turn = rot_z(0.7);
  x.bodies = {{.sensor = 0}, fixed_body(0, 1, turn)};
  x.bodies[1].point_in_parent = Vec3(0.3, 0.4, 0.0);
  x.errors.resize(2);
  x.spline_coefficients.resize(0, problem.grid.coefficients());
  const InsLayout layout = layout_of(problem, x.bodies);
  const Vec3 position = point_position(problem, layout, x, problem.facts.tapes[0].to, 0.5);
  EXPECT_LT((position - (Vec3(0.3, 0.4, 0.0) - turn * x.bodies[1].point_in_child)).norm(), 1e-14);
  EXPECT_NEAR(fact_cost(problem, layout, x), 100.0, 1e-9);  // 0.1 m with a tape of 1 cm
  problem.facts = {};
  EXPECT_EQ(fact_cost(problem, layout_of(problem, x.bodies), x), 0.0);
}

}  // namespace
}  // namespace kinfer
