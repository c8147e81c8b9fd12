// SPDX-License-Identifier: Apache-2.0
// A machine that was identified without magnetometers on a base that stood still, at work on slopes and rocking. On
// level ground zero and place of its upright joint, and where the sensor sits around it, stay open; on a slope, how the
// base's sensor is turned about gravity.
#include <cmath>

#include "track/tracked_case.hpp"

namespace kinfer::track {
namespace {

/// The truth, but for what such an identification does not see: the slew's zero, how what hangs on the slewing segment
/// is turned in the frame of its sensor, and where the slew's axis is on the base.
Case seen_on_level_ground(const test::DriveSetup& setup) {
  using Kind = TrackingParameterKind;
  Case given = make_case(setup);
  TrackingModel& model = given.model;
  TrackingBody& segment = model.bodies[1];
  const Vec3 axis = segment.child_R_axis.col(2), middle = segment.point_in_child;
  const Mat3 turn = exp_so3(2.2 * axis);
  segment.child_R_axis *= rot_z(-1.3);
  segment.point_in_parent += Vec3(0.4, -0.5, 0.6);
  model.parameters.push_back({Kind::child_rotation, 1, 2});
  const auto n = static_cast<Eigen::Index>(model.parameters.size());
  MatrixXd covariance = MatrixXd::Zero(n, n);
  covariance.topLeftCorner(n - 1, n - 1) = model.covariance;
  covariance(n - 1, n - 1) = 9.0;
  VectorXd by_turn = VectorXd::Zero(n);
  for (std::size_t b = 2; b < model.bodies.size(); ++b) {
    TrackingBody& next = model.bodies[b];
    if (next.parent != 1) continue;
    next.parent_R_axis = turn * next.parent_R_axis;
    next.point_in_parent = middle + turn * (next.point_in_parent - middle);
    const Vec3 turned = next.parent_R_axis.transpose() * axis, moved = axis.cross(next.point_in_parent - middle);
    for (Eigen::Index i = 0; i < n; ++i) {
      const TrackingParameter& parameter = model.parameters[static_cast<std::size_t>(i)];
      if (parameter.index != static_cast<int>(b)) continue;
      if (parameter.kind == Kind::parent_rotation) by_turn[i] = turned[parameter.component];
      if (parameter.kind == Kind::point_in_parent) by_turn[i] = moved[parameter.component];
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const TrackingParameter& parameter = model.parameters[static_cast<std::size_t>(i)];
    if (parameter.index == 1 && parameter.kind == Kind::point_in_parent) covariance(i, i) = 1.0;
  }
  model.covariance = covariance + by_turn * by_turn.transpose();
  return given;
}

/// The truth, but for what an identification on a slope does not see: all beyond the base is turned about gravity as it
/// was then, at an angle [deg] to the slew's axis.
Case seen_on_slope(const test::DriveSetup& setup, double cone) {
  using Kind = TrackingParameterKind;
  Case given = make_case(setup);
  TrackingModel& model = given.model;
  TrackingBody& segment = model.bodies[1];
  const Vec3 up_in_axes = rot_x(cone * degree).col(2), up = segment.parent_R_axis * up_in_axes;
  model.base = {.moved = false, .force = model.gravity * up};
  segment.parent_R_axis = exp_so3(2.2 * up) * segment.parent_R_axis;
  segment.point_in_parent += Vec3(0.4, -0.5, 0.6);
  model.parameters.push_back({Kind::child_rotation, 1, 2});
  const auto n = static_cast<Eigen::Index>(model.parameters.size());
  MatrixXd covariance = MatrixXd::Zero(n, n);
  covariance.topLeftCorner(n - 1, n - 1) = model.covariance;
  VectorXd by_turn = VectorXd::Zero(n);
  by_turn[n - 1] = -up_in_axes.z();
  for (Eigen::Index i = 0; i < n; ++i) {
    const TrackingParameter& parameter = model.parameters[static_cast<std::size_t>(i)];
    if (parameter.index != 1) continue;
    if (parameter.kind == Kind::parent_rotation) by_turn[i] = up_in_axes[parameter.component];
    if (parameter.kind == Kind::point_in_parent) covariance(i, i) = 1.0;
  }
  model.covariance = covariance + 9.0 * by_turn * by_turn.transpose();
  return given;
}

/// Errors of the joints' positions over their standard deviations, and after 15 s [rad]; of the slew since its start.
struct Errors {
  VectorXd ratio, late;
  bool is_relative = true, has_alarm = false;
};

Errors errors_of(const Case& given, const TrackOptions& options = {}) {
  Tracker tracker(given.model, options);
  const int joints = given.model.positions();
  Errors errors{VectorXd::Zero(joints), VectorXd::Zero(joints)};
  double first = no_value, first_sd = no_value;
  InsRow row;
  for (std::size_t r = 0; r < given.drive.recording.loggers.front().time.size(); ++r) {
    test::fill_row(given.drive.recording, r, row);
    tracker.add(row);
    const TrackState& state = tracker.state();
    errors.has_alarm |= !state.alarms.empty();
    if (!state.started) continue;
    errors.is_relative &= state.joints[0].reference == JointReference::start;
    if (std::isnan(first)) first = state.q[0] - given.drive.q(0, r), first_sd = state.sd_q[0];
    for (int j = 0; j < joints; ++j) {
      const double e = std::abs(state.q[j] - given.drive.q(j, r) - (j == 0 ? first : 0.0));
      errors.ratio[j] = std::max(errors.ratio[j], e / std::hypot(state.sd_q[j], j == 0 ? first_sd : 0.0));
      if (row.time > 15.0) errors.late[j] = std::max(errors.late[j], e);
    }
  }
  return errors;
}

void expect_counts_from_start(const Case& given) {
  const Errors errors = errors_of(given);
  EXPECT_TRUE(errors.is_relative);
  EXPECT_FALSE(errors.has_alarm);
  EXPECT_LT(errors.late.maxCoeff(), 0.4 * degree);
  EXPECT_LT(errors.ratio.maxCoeff(), 6.0);
}

class OpenSlew : public ::testing::TestWithParam<test::DriveSetup> {};

TEST_P(OpenSlew, CountsFromItsStartAndTheNextJointsAreFound) {
  expect_counts_from_start(seen_on_level_ground(GetParam()));
}

TEST_P(OpenSlew, CountsFromItsStartWhereverItsAxisIsOnACone) {
  for (const double cone : {1.5, 8.0}) expect_counts_from_start(seen_on_slope(GetParam(), cone));
}

INSTANTIATE_TEST_SUITE_P(On, OpenSlew,
                         ::testing::Values(test::DriveSetup{.duration = 40.0},
                                           test::DriveSetup{.slope = 2.0, .duration = 40.0},
                                           test::DriveSetup{.machine = "robot6", .slope = 5.0, .duration = 40.0},
                                           test::DriveSetup{.base = Base::rocking, .duration = 40.0}));

TEST(OpenSlew, StandsWhereTheUserSaysAtTheStart) {
  const Case given = seen_on_level_ground({.slope = 3.0, .duration = 20.0});
  VectorXd start = VectorXd::Constant(given.model.positions(), no_value);
  start[0] = 0.7;
  const Outcome out = run(given, {.start = start}, unchanged);
  const auto last = given.drive.recording.loggers.front().time.size() - 1;
  EXPECT_NEAR(out.tracker.state().q[0], 0.7 + given.drive.q(0, last) - given.drive.q(0, 0), 0.1 * degree);
  EXPECT_TRUE(out.alarms.empty());
}

}  // namespace
}  // namespace kinfer::track
