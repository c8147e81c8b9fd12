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

/// The axis of a joint that swings by 1 rad, seen for 30 s.
track::AxisSpread swinging_axis(const std::complex<double>& in_parent, const std::complex<double>& in_child,
                                double noise) {
  track::AxisSpread axis;
  Rng rng(7);
  for (int i = 0; i < 3000; ++i) {
    const double q = std::sin(0.02 * i);
    const std::complex<double> y = in_parent + in_child * std::polar(1.0, q);
    axis.add({y.real() + noise * rng.normal(), y.imag() + noise * rng.normal()}, q, 0.01);
  }
  return axis;
}

TEST(AxisSpread, AnErrorOfTheAxisInEitherBodyIsNoneOfTheOrientations) {
  const track::AxisSpread axis = swinging_axis({0.02, -0.01}, {0.03, 0.04}, 0.0);
  EXPECT_GT(axis.variance(), 1e-4);
  EXPECT_LT(axis.unexplained(), 1e-9);
}

TEST(AxisSpread, WhatVariesBesideIsTheirs) {
  const track::AxisSpread axis = swinging_axis({0.02, -0.01}, {0.03, 0.04}, 0.01);
  EXPECT_NEAR(axis.unexplained(), 1e-4, 1e-5);
}

TEST(AxisSpread, AJointThatDoesNotTurnTellsNoErrorInTheChild) {
  track::AxisSpread axis;
  for (int i = 0; i < 1000; ++i) axis.add({0.01 * (i % 2), 0.0}, 0.3 + 1e-3 * (i % 2), 0.01);
  EXPECT_NEAR(axis.unexplained(), axis.variance(), 1e-12);
  EXPECT_GT(axis.variance(), 1e-5);
}

TEST(ComposedFilters, DoNotKnowADisplacement) {
  const TrackingModel model = two_bodies(TrackingMotion::prismatic, Mat3::Identity());
  ComposedFilters filters(model);
  filters.add(row_at(model, Mat3::Identity(), 0.01));
  EXPECT_TRUE(std::isnan(filters.state().q[0]));
}

}  // namespace
}  // namespace kinfer
