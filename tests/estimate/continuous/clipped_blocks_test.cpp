// SPDX-License-Identifier: Apache-2.0
// Clipped samples as bounds: what they contain, and their part in cost and gradient.
#include "kinfer/estimate/continuous/model/clipped_blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/model/retraction.hpp"
#include "kinfer/estimate/continuous/solver/block_residual.hpp"
#include "kinfer/estimate/continuous/solver/linearisation.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using test::random_vector;

constexpr float range = 0.5f;

/// A gyroscope whose x axis follows `rate`, clipped at the range; y reads 0.2.
struct ClippedGyroscope {
  InsSensor sensor{.name = "s", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  std::vector<double> time;

  template <class Rate>
  explicit ClippedGyroscope(const Rate& rate, int rows = 60) {
    for (int row = 0; row < rows; ++row) {
      time.push_back(0.02 * row + 0.01);
      const auto x = static_cast<float>(rate(time.back()));
      for (std::size_t k = 0; k < 3; ++k) {
        sensor.angular_velocity.axis[k].push_back(k == 0 ? std::clamp(x, -range, range) : k == 1 ? 0.2f : 0.0f);
        sensor.acceleration.axis[k].push_back(k == 2 ? 9.8f : 0.0f);
      }
      sensor.faults.push_back(std::abs(x) >= range ? std::uint8_t{angular_velocity_clipped} : std::uint8_t{0});
    }
  }
};

constexpr SplineGrid grid{.begin = 0.0, .period = 0.1, .intervals = 12};

TEST(ClippedBlocks, KeepTheirSampleCountSidesAndUnclippedAxes) {
  const ClippedGyroscope gyroscope([](double t) { return t < 0.5 ? 1.0 : t < 0.8 ? -1.0 : 0.1; });
  const InsClippedBlocks clipped = clipped_blocks(gyroscope.sensor, gyroscope.time, InsInstrument::gyroscope, grid);
  ASSERT_EQ(clipped.blocks.size(), 12u);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_EQ(clipped.blocks[k].samples, 5) << k;
    double weight = 0.0;
    for (Index row = 0; row < clipped.blocks[k].rows; ++row) {
      const double root = double{clipped.blocks[k].factor.row(row).sum()};
      weight += root * root;
      EXPECT_EQ(clipped.sides[k][static_cast<std::size_t>(row)], (ClippedSides{std::int8_t(k < 5 ? 1 : -1), 0, 0}));
      EXPECT_NEAR(double{clipped.blocks[k].target(row, 1)} / root, 0.2, 1e-6);
      EXPECT_NEAR(double{clipped.blocks[k].target(row, 0)} / root, k < 5 ? 0.5 : -0.5, 1e-6);
    }
    EXPECT_NEAR(weight, 5.0, 1e-5);
  }
  EXPECT_EQ(clipped.blocks[9].rows, 0);
}

TEST(ClippedBlocks, AreNoneOfAnInstrumentThatNeverClips) {
  const ClippedGyroscope gyroscope([](double) { return 0.3; });
  EXPECT_TRUE(clipped_blocks(gyroscope.sensor, gyroscope.time, InsInstrument::gyroscope, grid).empty());
}

/// A revolute joint whose second INS has only bounds on its angular velocity.
struct BoundExample {
  InsProblem problem;
  InsUnknowns x;
  InsLayout layout;

  BoundExample() {
    Rng rng(3);
    problem.grid = grid;
    problem.prior = {
        .gyroscope_bias = 1e-2, .accelerometer_bias = 0.1, .gyroscope_scale = 0.01, .accelerometer_scale = 0.01};
    problem.sensors.resize(2);
    const ClippedGyroscope gyroscope([](double t) { return std::sin(9.0 * t); });
    for (InsMeasurements& sensor : problem.sensors) {
      sensor.noise = {0.1, 0.5};
      sensor.angular_velocity = ins_blocks(gyroscope.sensor, gyroscope.time, InsInstrument::gyroscope, grid);
      sensor.force = ins_blocks(gyroscope.sensor, gyroscope.time, InsInstrument::accelerometer, grid);
    }
    problem.sensors[1].clipped_rate = clipped_blocks(gyroscope.sensor, gyroscope.time, InsInstrument::gyroscope, grid);
    x.bodies = {{.sensor = 0}, test::random_revolute_body(0, 1, rng)};
    x.root_force = random_vector(rng);
    x.errors.resize(2);
    layout = layout_of(problem, x.bodies);
    x.spline_coefficients = test::random_matrix(1, grid.coefficients(), 5);
  }
  double cost(Index unknown, double step) const {
    VectorXd border = VectorXd::Zero(layout.global_parameters);
    border[unknown] = step;
    const MatrixXd none = MatrixXd::Zero(1, x.spline_coefficients.cols());
    return cost_of(problem, layout, retract(problem, layout, x, {none, border, {}}), 1).total;
  }
};

TEST(ClippedBlocks, GradientsOfBoundsAgreeWithDifferences) {
  const BoundExample e;
  const InsLinearisation linearisation(e.problem, e.layout, e.x);
  VectorXd gradient = global_parameter_prior(e.problem, e.layout, e.x).right;
  for (const IntervalGradient& g : linearisation.gradients({0, grid.intervals})) gradient += g.border;
  for (Index k = 0; k < e.layout.global_parameters; ++k) {
    const double step = 1e-6, slope = (e.cost(k, step) - e.cost(k, -step)) / (2.0 * step);
    EXPECT_NEAR(-2.0 * gradient[k], slope, 1e-4 * std::max(1.0, std::abs(slope))) << k;
  }
}

TEST(ClippedBlocks, ABoundCostsOnlyWhatIsInsideTheRange) {
  BlockResidual outside = BlockResidual::Constant(-1.0), inside = BlockResidual::Constant(1.0);
  const std::vector<std::array<ClippedSides, block_nodes>> sides(1, {ClippedSides{1, -1, 0}, {1, 0, 0}, {}, {}});
  const std::vector<InsBlock> blocks(1);
  const InstrumentMeasurements bound{blocks, 1.0, nullptr, 0, &sides};
  drop_satisfied(outside, bound, 0);  // measured − predicted < 0: the prediction is beyond an upper end
  drop_satisfied(inside, bound, 0);
  EXPECT_EQ(outside.row(0), Eigen::RowVector3d(0.0, -1.0, -1.0));
  EXPECT_EQ(outside.row(1), Eigen::RowVector3d(0.0, -1.0, -1.0));
  EXPECT_EQ(outside.row(2), Eigen::RowVector3d(-1.0, -1.0, -1.0));
  EXPECT_EQ(inside.row(0), Eigen::RowVector3d(1.0, 0.0, 1.0));
}

}  // namespace
}  // namespace kinfer
