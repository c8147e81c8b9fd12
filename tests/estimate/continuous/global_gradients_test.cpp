// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/model/retraction.hpp"
#include "kinfer/estimate/continuous/solver/linearisation.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using test::random_vector;

struct ClockExample {
  InsProblem problem;
  InsUnknowns x;
  InsLayout layout;
};

/// A revolute joint whose two INS return random samples, with clocks that differ.
ClockExample clock_example() {
  Rng rng(3);
  ClockExample e;
  e.problem.grid = {.begin = 0.0, .period = 0.1, .intervals = 12};
  e.problem.prior = {.gyroscope_bias = 1e-2, .accelerometer_bias = 0.1, .clock_offset = 0.01, .clock_drift = 0.1};
  for (std::size_t s = 0; s < 2; ++s) {
    InsMeasurements measurements{.angular_velocity = {}, .force = {}, .noise = {0.5, 0.5}, .noise_floor = {}};
    InsSensor sensor{.name = "s", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
    std::vector<double> time;
    for (int row = 0; row < 60; ++row) {
      time.push_back(0.02 * row);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        sensor.angular_velocity.axis[axis].push_back(static_cast<float>(rng.normal()));
        sensor.acceleration.axis[axis].push_back(static_cast<float>(rng.normal()));
      }
      sensor.faults.push_back(0);
    }
    measurements.angular_velocity = ins_blocks(sensor, time, InsInstrument::gyroscope, e.problem.grid);
    measurements.force = ins_blocks(sensor, time, InsInstrument::accelerometer, e.problem.grid);
    e.problem.sensors.push_back(measurements);
  }
  e.x.bodies = {{.sensor = 0}, test::random_revolute_body(0, 1, rng)};
  e.x.bodies[1].point_in_child = random_vector(rng);
  e.x.root_force = random_vector(rng);
  e.x.errors.resize(2);
  e.x.errors[1].clock = {.offset = 0.004, .drift = 0.003};
  e.x.spline_coefficients = MatrixXd(1, e.problem.grid.coefficients());
  for (Index i = 0; i < e.x.spline_coefficients.size(); ++i) e.x.spline_coefficients.data()[i] = 0.3 * rng.normal();
  e.layout = layout_of(e.problem, e.x.bodies);
  return e;
}

double cost_after(const ClockExample& e, Index unknown, double step) {
  VectorXd global_step = VectorXd::Zero(e.layout.global_parameters);
  global_step[unknown] = step;
  const InsUnknowns x =
      retract(e.problem, e.layout, e.x, {MatrixXd::Zero(1, e.x.spline_coefficients.cols()), global_step, {}});
  return cost_of(e.problem, e.layout, x, 1).total;
}

TEST(GlobalGradients, OfEveryParameterAgreeWithDifferences) {
  const ClockExample e = clock_example();
  const InsLinearisation linearisation(e.problem, e.layout, e.x);
  VectorXd gradient = global_parameter_prior(e.problem, e.layout, e.x).right;
  for (const IntervalGradient& g : linearisation.gradients({0, e.problem.grid.intervals})) gradient += g.border;
  const Index reference = e.layout.error[0] + e.layout.clock_error;
  for (Index k = 0; k < e.layout.global_parameters; ++k) {
    if (k == reference || k == reference + 1) continue;  // held by priors far too tight for differences
    const double step = 1e-6;
    const double slope = (cost_after(e, k, step) - cost_after(e, k, -step)) / (2.0 * step);
    EXPECT_NEAR(-2.0 * gradient[k], slope, 1e-5 * std::max(1.0, std::abs(slope))) << k;
  }
}

TEST(MeasurementBlocks, ThePolynomialsDerivativeIsExactForCubics) {
  const auto& u = block_nodes_u();
  Eigen::Matrix<double, block_nodes, 1> values, slopes;
  for (Index i = 0; i < block_nodes; ++i) {
    const double x = u[static_cast<std::size_t>(i)];
    values[i] = 1.0 - 2.0 * x + 3.0 * x * x - 0.7 * x * x * x;
    slopes[i] = -2.0 + 6.0 * x - 2.1 * x * x;
  }
  EXPECT_LT((node_derivative() * values - slopes).norm(), 1e-12);
}

}  // namespace
}  // namespace kinfer
