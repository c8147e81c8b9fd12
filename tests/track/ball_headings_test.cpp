// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/geometry/random.hpp"
#include "kinfer/track/tracker.hpp"

namespace kinfer::track {
namespace {

constexpr double period = 0.01, rest = 2.0,
                 heading = 0.4;  // [s], [s], [rad] of the ball beside the middle of its range
const Vec3 ball_point(0.7, 0.1, 0.0), sensor_beyond(0.4, 0.0, -0.1), sensor_before(0.3, 0.0, 0.1);
const InsLevel noise{.rate = 1e-3, .force = 1e-2};

/// A hinge across the vertical on a level base, and a ball at its end.
TrackingModel hinge_and_ball(const InsLevel& residual) {
  TrackingModel model;
  for (int s = 0; s < 3; ++s)
    model.sensors.push_back({.name = "ins" + std::to_string(s),
                             .body = s,
                             .noise = noise,
                             .residual = s == 0 ? noise : residual,
                             .slow_residual = noise,
                             .sample_period = period});
  model.bodies.push_back({.sensor = 0});
  model.bodies.push_back({.parent = 0, .sensor = 1, .joint = 0, .motion = TrackingMotion::revolute});
  model.bodies.back().parent_R_axis = model.bodies.back().child_R_axis = rot_x(-0.5 * std::numbers::pi);
  model.bodies.back().point_in_child = -sensor_before;
  model.bodies.push_back({.parent = 1, .sensor = 2, .joint = 1, .motion = TrackingMotion::spherical});
  model.bodies.back().point_in_parent = ball_point - sensor_before;
  model.bodies.back().point_in_child = -sensor_beyond;
  model.joints.push_back({.name = "ins0-ins1", .positions = 1, .range = {{-1.0, 1.0, 2.0, 4.0}}});
  const TrackingRange seen{-0.7, 0.7, 2.0, 4.0};
  model.joints.push_back({.name = "ins1-ins2",
                          .type = EstimatedJointType::spherical,
                          .first_position = 1,
                          .positions = 3,
                          .range = {seen, seen, seen}});
  model.covariance.resize(0, 0);
  return model;
}

/// At rest, then the hinge swings; the ball keeps its rotation.
InsRow row_at(int i) {
  const double t = i * period, w = 3.0, s = std::max(0.0, t - rest);
  const double q = 0.3 * (1.0 - std::cos(w * s)), qd = 0.3 * w * std::sin(w * s),
               qdd = s > 0.0 ? 0.3 * w * w * std::cos(w * s) : 0.0;
  const Mat3 world_R_arm = rot_y(q), arm_R_child = rot_z(heading);
  const Vec3 omega(0.0, qd, 0.0), alpha(0.0, qdd, 0.0), up = world_R_arm.transpose() * Vec3::UnitZ();
  const auto force = [&](const Vec3& at) {
    return Vec3(standard_gravity * up + alpha.cross(at) + omega.cross(omega.cross(at)));
  };
  InsRow row{.time = t, .sensors = {}};
  int stream = 3 * i;
  const auto add = [&](const Vec3& f, const Vec3& rate) {
    Rng rng = Rng(7).stream(static_cast<std::uint64_t>(stream++));
    row.sensors.push_back({.time = t,
                           .acceleration = f + noise.force * normal_vector(rng),
                           .angular_velocity = rate + noise.rate * normal_vector(rng),
                           .has_acceleration = true,
                           .has_angular_velocity = true});
  };
  add(standard_gravity * Vec3::UnitZ(), Vec3::Zero());
  add(force(sensor_before), omega);
  add(arm_R_child.transpose() * force(ball_point + arm_R_child * sensor_beyond), arm_R_child.transpose() * omega);
  return row;
}

struct Heading {
  double error = 0.0, sd = 0.0;  // [rad]
};

Heading stated(const Tracker& tracker) {
  return {tracker.state().q[3] - heading, tracker.state().sd_q[3]};
}

TEST(BallHeadings, AreFoundByTheMotionOfTheirParentAndUncertainUntilThen) {
  Tracker tracker(hinge_and_ball(noise));
  int i = 0;
  for (; i * period < rest; ++i) tracker.add(row_at(i));
  EXPECT_GT(stated(tracker).sd, 0.3) << "noise at rest tells nothing";
  EXPECT_LT(std::abs(stated(tracker).error), 2.0 * stated(tracker).sd);
  for (; i * period < rest + 8.0; ++i) {
    tracker.add(row_at(i));
    EXPECT_TRUE(tracker.state().alarms.empty()) << "at " << i * period;
  }
  EXPECT_EQ(tracker.state().joints[1].reference, JointReference::chain);
  EXPECT_LT(stated(tracker).sd, 0.01);
  EXPECT_LT(std::abs(stated(tracker).error), 3.0 * stated(tracker).sd);
}

/// What the accelerations of slack mounts have beyond noise lasts, and would be taken for a heading.
TEST(BallHeadings, CountFromTheStartOnSlackMountsOfAStillBase) {
  Tracker tracker(hinge_and_ball({.rate = 2e-2, .force = 0.2}));
  for (int i = 0; i * period < rest; ++i) tracker.add(row_at(i));
  EXPECT_EQ(tracker.state().joints[1].reference, JointReference::start);
}

}  // namespace
}  // namespace kinfer::track
