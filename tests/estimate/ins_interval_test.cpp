// SPDX-License-Identifier: Apache-2.0
// What holds within one interval of the grid: motion of all bodies and its derivatives.
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
  /// All vectors of a body's state at a node, one after the other.
  VectorXd state(const InsUnknowns& at, std::size_t body, Index interval, std::size_t node) const {
    const InsState s = body_states(problem, layout, at, interval, node_bases(problem.grid)[node])[body];
    return (VectorXd(state_size) << s.angular_velocity, s.angular_acceleration, s.force).finished();
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
          VectorXd analytic = VectorXd::Zero(state_size);
          for (Index component = 0; component < state_size; ++component)
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
