// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/composed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/evidence/tracking/body_poses.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using track::ComposedFilters;

/// Two bodies whose joint's point is in both sensors' origins.
TrackingModel two_bodies(TrackingMotion motion, const Mat3& parent_R_axis) {
  TrackingModel model;
  model.sensors = {{.name = "ins0", .body = 0}, {.name = "ins1", .body = 1}};
  model.bodies.push_back({.sensor = 0});
  model.bodies.push_back({.parent = 0, .sensor = 1, .joint = 0, .motion = motion, .parent_R_axis = parent_R_axis});
  model.bodies.back().child_R_axis = exp_so3(Vec3(0.3, -0.2, 0.9));
  const bool is_ball = motion == TrackingMotion::spherical;
  model.joints.push_back({.name = "ins0-ins1",
                          .type = is_ball                               ? EstimatedJointType::spherical
                                  : motion == TrackingMotion::prismatic ? EstimatedJointType::prismatic
                                                                        : EstimatedJointType::revolute,
                          .positions = is_ball ? 3 : 1});
  model.covariance.resize(0, 0);
  return model;
}

VectorXd driven_to(const TrackingModel& model, double t) {
  VectorXd q(model.positions());
  for (Index k = 0; k < q.size(); ++k) {
    const double turns = 0.3 * t * (1.0 + 0.4 * static_cast<double>(k));
    q[k] =
        t < 3.0 ? 0.0 : 0.6 * std::sin(2.0 * std::numbers::pi * (turns - 0.9 * (1.0 + 0.4 * static_cast<double>(k))));
  }
  return q;
}

/// What perfect sensors measure on a base that stands in this orientation.
InsRow row_at(const TrackingModel& model, const Mat3& world_R_base, double t) {
  constexpr double h = 1e-4;
  const auto child_at = [&](double time) {
    return Mat3(world_R_base * body_poses(model, driven_to(model, time))[1].rotation);
  };
  InsRow row{.time = t, .sensors = {}};
  const auto add = [&](const Mat3& world_R_sensor, const Vec3& rate) {
    row.sensors.push_back({.time = t,
                           .acceleration = world_R_sensor.transpose() * Vec3(0.0, 0.0, 9.81),
                           .angular_velocity = rate,
                           .has_acceleration = true,
                           .has_angular_velocity = true});
  };
  add(world_R_base, Vec3::Zero());
  add(child_at(t), log_so3(child_at(t - h).transpose() * child_at(t + h)) / (2.0 * h));
  return row;
}

/// Largest error of the positions after the first 5 s [rad].
double worst_error(const TrackingModel& model, const Mat3& world_R_base, const track::TrackOptions& options = {}) {
  constexpr double dt = 0.01;
  ComposedFilters filters(model, options);
  double worst = 0.0;
  for (int i = 1; i <= 3000; ++i) {
    const double t = dt * i;
    filters.add(row_at(model, world_R_base, t));
    if (t < 5.0) continue;
    const VectorXd error = filters.state().q - driven_to(model, t);
    if (!error.allFinite()) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, error.cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(ComposedFilters, FollowAHingeWithAHorizontalAxis) {
  const TrackingModel model = two_bodies(TrackingMotion::revolute, rot_x(std::numbers::pi / 2.0));
  EXPECT_LT(worst_error(model, rot_z(0.7)), 0.3 * degree);
}

TEST(ComposedFilters, FollowAVerticalHingeFromWhereItStarted) {
  const TrackingModel model = two_bodies(TrackingMotion::revolute, Mat3::Identity());
  EXPECT_LT(worst_error(model, Mat3::Identity()), 0.3 * degree);
  ComposedFilters filters(model);
  filters.add(row_at(model, Mat3::Identity(), 0.01));
  EXPECT_EQ(filters.state().joints[0].reference, JointReference::start);
  EXPECT_GT(filters.state().sd_q[0], 0.5) << "nobody knows where it started";
}

TEST(ComposedFilters, TakeTheUsersStart) {
  const TrackingModel model = two_bodies(TrackingMotion::revolute, Mat3::Identity());
  track::TrackOptions options;
  options.start = VectorXd::Constant(1, 0.4);
  ComposedFilters filters(model, options);
  filters.add(row_at(model, Mat3::Identity(), 0.01));
  EXPECT_NEAR(filters.state().q[0], 0.4, 1e-6);
  EXPECT_EQ(filters.state().joints[0].reference, JointReference::chain);
  EXPECT_LT(filters.state().sd_q[0], 0.01);
}

TEST(ComposedFilters, FollowABall) {
  const TrackingModel model = two_bodies(TrackingMotion::spherical, exp_so3(Vec3(0.1, 0.5, -0.2)));
  EXPECT_LT(worst_error(model, rot_y(0.2)), 0.5 * degree);
}

/// An inclined hinge that is in motion from the first row on, whose force is 3 m/s² off: 17° in the tilt. The largest
/// error of the position in two seconds from `from` on.
double error_after_start_in_motion(double from) {
  constexpr double dt = 0.01;
  const TrackingModel model = two_bodies(TrackingMotion::revolute, rot_x(std::numbers::pi / 4.0));
  ComposedFilters filters(model);
  double worst = 0.0;
  for (int i = 1; i * dt < from + 2.0; ++i) {
    const double t = 3.0 + dt * i;
    InsRow row = row_at(model, rot_z(0.7), t);
    if (i == 1) row.sensors[1].acceleration += Vec3(2.0, -2.0, 1.0);
    filters.add(row);
    if (i * dt > from) worst = std::max(worst, std::abs(filters.state().q[0] - driven_to(model, t)[0]));
  }
  return worst;
}

TEST(ComposedFilters, TakeNoLastingHeadingFromAnAxisThatTiltedFiltersSee) {
  EXPECT_LT(error_after_start_in_motion(2.5), 0.1 * degree);
}

/// A loose hinge whose axis strays by `sway` to and fro, twice as far as it did in the identification; the rms error of
/// the rotation.
double error_of_swaying_axis(double sway) {
  constexpr double dt = 0.01, h = 1e-4;
  TrackingModel model = two_bodies(TrackingMotion::revolute, rot_x(std::numbers::pi / 2.0));
  model.joints[0].stray = 0.5 * sway / std::numbers::sqrt2;
  const TrackingBody& body = model.bodies[1];
  const auto rotation_at = [&](double t) {
    const Vec3 tilt(sway * std::sin(7.0 * t), sway * std::cos(5.0 * t), 0.0);
    return Mat3(body.parent_R_axis * exp_so3(tilt) * rot_z(0.5 * std::sin(t)) * body.child_R_axis.transpose());
  };
  ComposedFilters filters(model);
  double sum = 0.0;
  int rows = 0;
  for (int i = 1; i <= 2000; ++i) {
    const double t = dt * i;
    InsRow row = row_at(model, Mat3::Identity(), t);
    row.sensors[1].acceleration = rotation_at(t).transpose() * Vec3(0.0, 0.0, 9.81);
    row.sensors[1].angular_velocity = log_so3(rotation_at(t - h).transpose() * rotation_at(t + h)) / (2.0 * h);
    filters.add(row);
    if (t < 5.0) continue;
    const Mat3 found = filters.state().joints[0].parent_q_child.toRotationMatrix();
    sum += log_so3(rotation_at(t).transpose() * found).squaredNorm();
    ++rows;
  }
  return std::sqrt(sum / rows);
}

TEST(ComposedFilters, BelieveALooseAxisThatStraysFartherThanItDid) {
  constexpr double sway = 0.07;
  EXPECT_LT(error_of_swaying_axis(sway), 0.35 * sway);
}

TEST(ComposedFilters, AnAccelerometersErrorsMakeTheTiltUncertainUnlessThePriorHardlyAllowsThem) {
  const auto tilt_variance = [](double bias) {
    TrackingModel model = two_bodies(TrackingMotion::revolute, rot_x(std::numbers::pi / 2.0));
    model.prior.bias.force = 0.2;
    model.sensors[1].accelerometer_bias = Vec3::Constant(bias);
    ComposedFilters filters(model);
    for (int i = 1; i <= 500; ++i) filters.add(row_at(model, rot_z(0.7), 0.01 * i));
    return filters.tilt_variance(0);
  };
  EXPECT_NEAR(tilt_variance(0.3) - tilt_variance(0.0), 0.3 * 0.3 / (9.80665 * 9.80665), 1e-5);
  EXPECT_NEAR(tilt_variance(1.0), tilt_variance(0.0), 1e-5);
}

/// What is seen of the axis of a joint that swings by 1 rad, for 30 s, where 0.01 rad are expected.
double excess_of(const std::complex<double>& in_parent, const std::complex<double>& in_child, double noise) {
  track::AxisSpread axis;
  Rng rng(7);
  for (int i = 0; i < 3000; ++i) {
    const double q = std::sin(0.02 * i);
    const std::complex<double> y = in_parent + in_child * std::polar(1.0, q);
    axis.add({y.real() + noise * rng.normal(), y.imag() + noise * rng.normal()}, q, 1e-4, 0.01);
  }
  return axis.excess();
}

TEST(AxisSpread, AnErrorOfTheAxisInEitherBodyIsNoneOfTheOrientations) {
  EXPECT_EQ(excess_of({0.02, -0.01}, {0.03, 0.04}, 0.0), 1.0);
}

TEST(AxisSpread, WhatVariesBesideIsTheirs) {
  EXPECT_NEAR(excess_of({0.02, -0.01}, {0.03, 0.04}, 0.02), 4.0, 0.4);
}

TEST(AxisSpread, AJointThatDoesNotTurnTellsNoErrorInTheChild) {
  track::AxisSpread axis;
  for (int i = 0; i < 1000; ++i) axis.add({0.06 * (i % 2), 0.0}, 0.3 + 1e-3 * (i % 2), 1e-4, 0.01);
  EXPECT_NEAR(axis.excess(), 0.5 * 9.0, 0.1);
}

TEST(AxisSpread, WhatWasExpectedWhileTheFiltersBeganIsNotHeldAgainstThem) {
  track::AxisSpread axis;
  Rng rng(7);
  for (int i = 0; i < 1000; ++i) {
    const double sd = i < 100 ? 0.1 : 0.005;
    axis.add({sd * rng.normal(), sd * rng.normal()}, std::sin(0.02 * i), sd * sd, 0.01);
  }
  EXPECT_NEAR(axis.excess(), 1.0, 0.1);
}

TEST(ComposedFilters, DoNotKnowADisplacement) {
  const TrackingModel model = two_bodies(TrackingMotion::prismatic, Mat3::Identity());
  ComposedFilters filters(model);
  filters.add(row_at(model, Mat3::Identity(), 0.01));
  EXPECT_TRUE(std::isnan(filters.state().q[0]));
}

}  // namespace
}  // namespace kinfer
