// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/mount_compliance.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/model/retraction.hpp"
#include "kinfer/estimate/continuous/solver/linearisation.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using test::random_vector;

Mat3 random_tilt(Rng& rng) {
  Mat3 tilt;
  for (Index j = 0; j < 3; ++j) tilt.col(j) = 0.2 * random_vector(rng);
  return tilt;
}

/// A moving machine with compliant sensor mounts.
struct MountExample {
  InsProblem problem;
  InsUnknowns x;
  InsLayout layout;

  MountExample() {
    Rng rng(5);
    problem.grid = {.begin = 0.0, .period = 0.1, .intervals = 8};
    problem.root_at_rest = false;
    problem.prior = {.gyroscope_bias = 0.1,
                     .accelerometer_bias = 0.1,
                     .gyroscope_scale = 0.1,
                     .accelerometer_scale = 0.1,
                     .tilt = 0.3};
    for (std::size_t s = 0; s < 2; ++s) {
      InsSensor sensor{.name = "s", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
      std::vector<double> time;
      for (int row = 0; row < 40; ++row) {
        time.push_back(0.02 * row);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          sensor.angular_velocity.axis[axis].push_back(static_cast<float>(rng.normal()));
          sensor.acceleration.axis[axis].push_back(static_cast<float>(rng.normal()));
        }
        sensor.faults.push_back(0);
      }
      problem.sensors.push_back({.angular_velocity = ins_blocks(sensor, time, InsInstrument::gyroscope, problem.grid),
                                 .force = ins_blocks(sensor, time, InsInstrument::accelerometer, problem.grid),
                                 .noise = {0.5, 0.5},
                                 .noise_floor = {},
                                 .mount_load = mount_loads(sensor, time, problem.grid)});
    }
    x.bodies = {{.sensor = 0}, test::random_revolute_body(0, 1, rng)};
    x.bodies[1].point_in_child = random_vector(rng);
    x.errors.resize(2);
    for (InsErrors& errors : x.errors) errors.tilt = random_tilt(rng), errors.gyroscope_scale = 0.2 * random_tilt(rng);
    x.spline_coefficients = MatrixXd(7, problem.grid.coefficients());
    for (double& value : x.spline_coefficients.reshaped()) value = 0.3 * rng.normal();
    layout = layout_of(problem, x.bodies);
  }

  double cost_after(ConstMatrixRef splines, ConstVectorRef globals) const {
    return cost_of(problem, layout, retract(problem, layout, x, {splines, globals, {}}), 1).total;
  }
};

TEST(MountCompliance, GradientsByComplianceAndMotionAgreeWithDifferences) {
  const MountExample e;
  const BandSegmentSum sum = InsLinearisation(e.problem, e.layout, e.x).sum({0, e.problem.grid.intervals});
  const VectorXd globals = global_parameter_prior(e.problem, e.layout, e.x).right + sum.border_right,
                 &splines = sum.right;
  constexpr double step = 1e-6;
  const auto expect_slope = [](double gradient, double more, double less) {
    const double slope = (more - less) / (2.0 * step);
    EXPECT_NEAR(-2.0 * gradient, slope, 1e-5 * std::max(1.0, std::abs(slope)));
  };
  const MatrixXd zero_splines = MatrixXd::Zero(e.x.spline_coefficients.rows(), e.x.spline_coefficients.cols());
  const VectorXd zero_globals = VectorXd::Zero(e.layout.global_parameters);
  for (Index k = 0; k < e.layout.global_parameters; ++k) {
    const VectorXd by = step * VectorXd::Unit(e.layout.global_parameters, k);
    expect_slope(globals[k], e.cost_after(zero_splines, by), e.cost_after(zero_splines, -by));
  }
  for (Index k = 0; k < splines.size(); k += 5) {
    MatrixXd by = zero_splines;
    by.reshaped()[k] = step;
    expect_slope(splines[k], e.cost_after(by, zero_globals), e.cost_after(-by, zero_globals));
  }
}

TEST(MountCompliance, ARigidMountMeasuresItsSegmentsMotion) {
  Rng rng(2);
  const InsState segment{random_vector(rng), random_vector(rng), random_vector(rng)};
  const Vec3 force = random_vector(rng), force_change = random_vector(rng);
  const InsState measured = state_on_mount(segment, Mat3::Zero(), force, force_change);
  EXPECT_EQ(measured.angular_velocity, segment.angular_velocity);
  EXPECT_EQ(measured.force, segment.force);
}

TEST(MountCompliance, TheTiltAddsToTheMeasuredRotation) {
  // Gravity in a segment rotated about x by a small angle a is g (0, a, 1): a compliance T about x by the force along y
  // adds T g a to the angle, so the factor T g to its angular velocity.
  const double angle = 0.01, angular_velocity = 0.3, gravity = 9.81, compliance = 0.1 / gravity;
  Mat3 tilt = Mat3::Zero();
  tilt(0, 1) = compliance;
  const InsState segment{.angular_velocity = Vec3(angular_velocity, 0.0, 0.0),
                         .force = gravity * Vec3(0.0, angle, 1.0)};
  const InsState measured =
      state_on_mount(segment, tilt, gravity * Vec3(0.0, angle, 0.0), gravity * Vec3(0.0, angular_velocity, 0.0));
  EXPECT_NEAR(measured.angular_velocity.x(), 1.1 * angular_velocity, 1e-12);
  EXPECT_NEAR(measured.force.y(), 1.1 * gravity * angle, 1e-5);
}

TEST(MountCompliance, TheTiltIsProportionalToTheForceLessItsMean) {
  const SplineGrid grid{0.0, 0.1, 60};
  InsSensor sensor{.name = "s", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  std::vector<double> time;
  for (int row = 0; row < 600; ++row) {
    time.push_back(0.01 * row);
    const double wave = 2.0 * std::sin(2.0 * time.back());
    sensor.acceleration.axis[0].push_back(static_cast<float>(wave));
    sensor.acceleration.axis[1].push_back(7.0f);
    sensor.acceleration.axis[2].push_back(0.0f);
    for (auto& axis : sensor.angular_velocity.axis) axis.push_back(0.0f);
    sensor.faults.push_back(0);
  }
  double mean = 0.0;
  for (const float value : sensor.acceleration.axis[0]) mean += double{value} / 600.0;
  const auto mount_load = mount_loads(sensor, time, grid);
  const double at = 2.0 + 0.1 * block_nodes_u()[1];
  EXPECT_NEAR(mount_load[20].force_at(1).x(), 2.0 * std::sin(2.0 * at) - mean, 1e-3);
  EXPECT_NEAR(mount_load[20].change_at(1).x(), 4.0 * std::cos(2.0 * at), 1e-2);
  EXPECT_NEAR(mount_load[20].force_at(1).y(), 0.0, 1e-6);
}

}  // namespace
}  // namespace kinfer
