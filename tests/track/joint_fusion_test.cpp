// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/joint_fusion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/track/readout/readout.hpp"

namespace kinfer {
namespace {

constexpr double turned = 0.4, period = 0.01;  // [rad], [s]

const Vec3 level(1.5707963, 0.0, 0.0), upright(0.0, 0.0, 0.0);  // turn of the axis z

/// A joint between two sensors.
TrackingModel hinge(const Vec3& axis = level) {
  TrackingModel model;
  model.sensors = {{.name = "ins0", .body = 0}, {.name = "ins1", .body = 1}};
  const Mat3 across = exp_so3(axis);
  model.bodies.push_back({.sensor = 0});
  model.bodies.push_back({.parent = 0, .sensor = 1, .joint = 0, .motion = TrackingMotion::revolute});
  model.bodies.back().parent_R_axis = model.bodies.back().child_R_axis = across;
  model.joints.push_back({.name = "ins0-ins1", .positions = 1});
  model.covariance.resize(0, 0);
  return model;
}

struct Stated {
  double q = 0.0, sd = 0.0;  // [rad]
};

/// Position of the joint after five seconds (500 rows) of rest at `turned`, where a filter on the chain states `at` of
/// each time.
template <class At>
TrackState fused(const At& at, bool is_sound, const TrackingModel& model, bool is_settled = true, int rows = 500) {
  track::ComposedFilters composed(model);
  track::JointFusion fusion(model);
  TrackState chain;
  const Mat3 across = model.bodies[1].parent_R_axis, relative = across * rot_z(turned) * across.transpose();
  for (int i = 0; i < rows; ++i) {
    InsRow row{.time = i * period, .sensors = {}};
    for (const Mat3& world_R_sensor : {Mat3(Mat3::Identity()), relative})
      row.sensors.push_back({.time = row.time,
                             .acceleration = world_R_sensor.transpose() * Vec3(0.0, 0.0, 9.81),
                             .angular_velocity = Vec3::Zero(),
                             .has_acceleration = true,
                             .has_angular_velocity = true});
    composed.add(row);
    chain = track::unknown_state(model);
    chain.time = row.time;
    const Stated stated = at(row.time);
    chain.q.setZero();
    chain.q[0] = stated.q;
    chain.qd.setZero();
    chain.sd_q.setConstant(stated.sd);
    chain.joints[0] = {.source = JointSource::chain,
                       .reference = JointReference::chain,
                       .parent_q_child = Quat(Mat3(across * rot_z(stated.q) * across.transpose()))};
    const std::vector<bool> sound{true, is_sound}, settled{is_settled};
    const std::vector<std::optional<double>> heading_sd(model.joints.size());
    fusion.apply(model, composed, {.is_sound = sound, .is_settled = settled, .heading_sd = heading_sd}, chain);
  }
  return chain;
}

TrackState fused(double q, double sd, bool is_sound) {
  return fused([&](double) { return Stated{q, sd}; }, is_sound, hinge());
}

/// It knows the accelerometers' errors, which the sensors' own filters do not.
TEST(JointFusion, AChainThatFitsIsLeftAlone) {
  TrackingModel model = hinge();
  model.prior.bias.force = 0.2;
  for (TrackingSensor& sensor : model.sensors) sensor.accelerometer_bias = Vec3(0.1, 0.1, 0.1);
  const TrackState state = fused([](double) { return Stated{turned + 0.02, 1e-3}; }, true, model);
  EXPECT_EQ(state.q[0], turned + 0.02);
  EXPECT_EQ(state.joints[0].source, JointSource::chain);
}

TEST(JointFusion, AChainThatSaysItDoesNotFitGivesWayToTheSensorsThemselves) {
  const TrackState state = fused(turned + 0.5, 0.6, true);
  EXPECT_NEAR(state.q[0], turned, 0.03);
  EXPECT_EQ(state.joints[0].source, JointSource::composed);
}

/// Its innovations follow what it does not explain with a delay; the sensors are as good as they were.
TEST(JointFusion, AChainFartherOffThanItStatesIsNotHeldAgainstTheSensors) {
  const TrackState state = fused(turned + 0.5, 0.1, true);
  EXPECT_NEAR(state.q[0], turned, 0.03);
}

TEST(JointFusion, TheFirstPositionIsAnAverageAlready) {
  const auto off = [](double) { return Stated{turned + 0.5, 1.5}; };
  EXPECT_NEAR(fused(off, true, hinge(), true, 1).q[0], turned, 0.03);
}

/// Motion does not show its heading, and the chain's sways by 3° about that of the sensors, which start at zero.
TEST(JointFusion, AHeadingThatCountsFromTheStartIsThatOfTheSensors) {
  TrackingModel model = hinge(upright);
  model.bodies[1].motion = TrackingMotion::spherical;
  model.joints[0].positions = 3;
  const auto swaying = [](double time) { return Stated{0.05 * std::sin(3.0 * time), 0.01}; };
  const TrackState state = fused(swaying, true, model);
  const Quat& found = state.joints[0].parent_q_child;
  const double sway = 0.05 * std::sin(3.0 * 4.99), heading = 2.0 * std::atan2(found.z(), found.w());
  EXPECT_LT(std::abs(heading), 0.2 * std::abs(sway));
}

TEST(JointFusion, AFaultySensorIsNotBelieved) {
  EXPECT_EQ(fused(turned + 0.5, 0.6, false).q[0], turned + 0.5);
}

TEST(JointFusion, AJointThatMayStandInSeveralPlacesIsLeftAlone) {
  const auto uncertain = [](double) { return Stated{turned + 0.5, 1.8}; };
  EXPECT_EQ(fused(uncertain, true, hinge(), false).q[0], turned + 0.5);
}

/// Of an upright axis the sensors themselves show no more than where it was when the chain knew little.
TEST(JointFusion, AChainThatLearnsWhereAnUprightJointStandsIsFollowedAtOnce) {
  const auto learning = [](double time) {
    return time < 4.9 ? Stated{turned + 0.04, 0.02} : Stated{turned + 0.001, 0.001};
  };
  EXPECT_NEAR(fused(learning, true, hinge(upright)).q[0], turned + 0.001, 1e-3);
}

}  // namespace
}  // namespace kinfer
