// SPDX-License-Identifier: Apache-2.0
// What holds within one interval of the grid: means of measurements, motion of all bodies and its derivatives.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/low_frequency.hpp"
#include "kinfer/estimate/continuous/model/interval_motion.hpp"
#include "kinfer/estimate/continuous/solver/covariance.hpp"
#include "kinfer/estimate/continuous/solver/normal_equations.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using test::random_vector;

TEST(MeanBlocks, HoldTheMeanOfEachIntervalAsOneRow) {
  InsSensor sensor{.name = "imu", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  std::vector<double> time;
  for (int row = 0; row < 40; ++row) {
    time.push_back(0.0123 * row);
    for (std::size_t k = 0; k < 3; ++k) {
      sensor.acceleration.axis[k].push_back(1.0f), sensor.angular_velocity.axis[k].push_back(0.0f);
      sensor.field.axis[k].push_back(static_cast<float>(20.0 + static_cast<double>(k) + 5.0 * time.back()));
    }
    sensor.faults.push_back(static_cast<std::uint8_t>(row == 3 ? +field_missing : 0));
  }
  const SplineGrid grid{0.0, 0.1, 6};
  const auto blocks = mean_blocks(sensor, time, InsInstrument::magnetometer, grid);
  ASSERT_EQ(blocks.size(), 6u);
  for (std::size_t k = 0; k < 4; ++k) {
    double mean = 0.0, count = 0.0;
    for (std::size_t row = 0; row < time.size(); ++row)
      if (row != 3 && static_cast<std::size_t>(time[row] / 0.1) == k) mean += 20.0 + 5.0 * time[row], count += 1.0;
    EXPECT_EQ(blocks[k].samples, static_cast<int>(count));
    EXPECT_EQ(blocks[k].rows, 1);
    EXPECT_NEAR(blocks[k].target(0, 0), mean / count, 1e-4);
    Eigen::Matrix<double, block_nodes, 1> truth;  // the factor predicts the mean from the values at the nodes
    for (std::size_t n = 0; n < block_nodes; ++n)
      truth[static_cast<Index>(n)] = 20.0 + 5.0 * 0.1 * (static_cast<double>(k) + block_nodes_u()[n]);
    EXPECT_NEAR(blocks[k].factor.row(0).cast<double>() * truth, mean / count, 1e-4);
  }
  EXPECT_EQ(blocks[5].samples, 0);
  EXPECT_EQ(measurement_noise(blocks), 0.0) << "a mean shows no noise";
}

TEST(GaussianWidth, LeavesAWaveOfTheCutoffAt71Percent) {
  for (const double cutoff : {0.5, 2.0, 7.0}) {
    const double phase = 2.0 * std::numbers::pi * cutoff * gaussian_width(cutoff);
    EXPECT_NEAR(std::exp(-0.5 * phase * phase), std::sqrt(0.5), 1e-14);
  }
}

/// A root in motion with a branch: two revolute joints in series, and a spherical one at the root.
struct BranchedMotion {
  InsProblem problem;
  InsUnknowns x;
  InsLayout layout;

  BranchedMotion() {
    Rng rng(8);
    const auto any_rotation = [&] { return exp_so3(random_vector(rng)); };
    problem.grid = {.begin = 0.0, .period = 0.1, .intervals = 5};
    problem.root_at_rest = false;
    problem.sensors.resize(4);
    x.bodies = {{.sensor = 0},
                test::random_revolute_body(0, 1, rng),
                test::random_revolute_body(1, 2, rng),
                spherical_body(0, 3, any_rotation())};
    for (InsBody& body : x.bodies) body.point_in_child = random_vector(rng), body.point_in_parent = random_vector(rng);
    x.errors.resize(4);
    layout = layout_of(problem, x.bodies);
    x.spline_coefficients = 0.3 * test::random_matrix(layout.spline_dimensions, problem.grid.coefficients(), 9);
  }
  /// All four vectors of a body's state at a node, one after the other.
  VectorXd state(const InsUnknowns& at, std::size_t body, Index interval, std::size_t node) const {
    const InsState s = body_states(problem, layout, at, interval, node_bases(problem.grid)[node])[body];
    return (VectorXd(12) << s.angular_velocity, s.angular_acceleration, s.force, s.field).finished();
  }
};

TEST(IntervalMotionOf, StatesAndTheirSplineDerivativesAgreeWithDifferences) {
  const BranchedMotion b;
  IntervalMotion motion(b.problem, b.layout, b.x, LinearisationScope::everything);
  constexpr Index interval = 2;
  motion.move_to(interval);
  for (std::size_t body = 0; body < 4; ++body)
    for (const std::size_t node : {0u, 3u}) {
      const BodyMotion& found = motion.body(body);
      EXPECT_LT((found.state[node].force - b.state(b.x, body, interval, node).segment<3>(6)).norm(), 1e-12);
      const auto& dimensions = motion.path(body).spline_dimensions;
      for (std::size_t d = 0; d < dimensions.size(); ++d)
        for (Index i = 0; i < spline_order; ++i) {
          const auto moved = [&](double by) {
            InsUnknowns x = b.x;
            x.spline_coefficients(dimensions[d], interval + i) += by;
            return b.state(x, body, interval, node);
          };
          const VectorXd slope = (moved(1e-5) - moved(-1e-5)) / 2e-5;
          VectorXd analytic = VectorXd::Zero(12);
          for (Index component = 0; component < 12; ++component)
            for (Index order = 0; order < derivative_orders; ++order)
              analytic[component] +=
                  found.by_spline(derivative_orders * static_cast<Index>(d) + order,
                                  component * block_nodes + static_cast<Index>(node)) *
                  motion.bases()[node].at[static_cast<std::size_t>(order)][static_cast<std::size_t>(i)];
          EXPECT_LT((analytic.head<9>() - slope.head<9>()).norm(), 1e-5 * (1 + slope.norm())) << body << ' ' << d;
        }
    }
}

TEST(IntervalMotionOf, PathsHoldTheUnknownsOfTheBodysOwnBranchOnly) {
  const BranchedMotion b;
  const auto paths = paths_of(b.problem, b.layout, b.x.bodies);
  EXPECT_EQ(number_of(paths[0].spline_dimensions), 6);
  EXPECT_EQ(paths[2].spline_dimensions, (std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(paths[3].spline_dimensions, (std::vector<Index>{0, 1, 2, 3, 4, 5, 8, 9, 10}));
  EXPECT_EQ(number_of(paths[2].rotational) + number_of(paths[2].translational),
            b.x.bodies[1].unknowns() + b.x.bodies[2].unknowns());
  const IntervalMotion held(b.problem, b.layout, b.x, LinearisationScope::spline_only);
  EXPECT_EQ(held.path(2).spline_dimensions, paths[2].spline_dimensions);
  EXPECT_TRUE(held.path(2).rotational.empty() && held.path(2).translational.empty());
}

TEST(ModelCovariance, IsTheInverseInformationAndTheSandwichOnlyWidensIt) {
  BranchedMotion b;
  b.problem.prior = {.gyroscope_bias = 0.1, .accelerometer_bias = 0.1};
  Rng rng(4);
  for (InsMeasurements& sensor : b.problem.sensors)
    for (auto* blocks : {&sensor.angular_velocity, &sensor.force}) {
      blocks->resize(5);
      for (InsBlock& block : *blocks) {
        block.rows = block.samples = 4;
        for (Index i = 0; i < 4; ++i) {
          for (Index j = i; j < block_nodes; ++j) block.factor(i, j) = static_cast<float>(rng.normal());
          block.target.row(i) = random_vector(rng).transpose().cast<float>();
        }
      }
    }
  b.layout = layout_of(b.problem, b.x.bodies);
  const InsSystem system(b.problem, b.layout, b.x, {}, 1);
  const auto model = model_covariance(system), both = covariance_of(system);
  ASSERT_TRUE(model && both);
  const Index n = b.layout.global_parameters;
  EXPECT_LT((model->model * system.schur() - MatrixXd::Identity(n, n)).norm(), 1e-6);
  EXPECT_EQ(model->inflation, VectorXd::Ones(n));
  EXPECT_EQ(model->model, both->model);
  EXPECT_GT(both->inflation.minCoeff(), 0.0);
}

TEST(ModelCovariance, OfWhatNeitherDataNorPriorsSayIsEmpty) {
  InsProblem problem;
  problem.grid = {.begin = 0.0, .period = 0.1, .intervals = 5};
  problem.sensors.resize(1);
  problem.sensors[0].angular_velocity.resize(5), problem.sensors[0].force.resize(5);
  constexpr double unknown = std::numeric_limits<double>::infinity();
  problem.prior = {.gyroscope_bias = unknown, .accelerometer_bias = unknown};
  InsUnknowns x;
  x.bodies = {{.sensor = 0}};
  x.root_force = Vec3(0, 0, 9.8);
  x.errors.resize(1);
  x.spline_coefficients.resize(0, problem.grid.coefficients());
  EXPECT_FALSE(covariance_of(problem, layout_of(problem, x.bodies), x, 1));
}

}  // namespace
}  // namespace kinfer
