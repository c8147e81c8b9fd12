// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/pair_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "identify/measured_segments.hpp"
#include "kinfer/base/rng.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::all_rows;
using test::freely_moving;
using test::general_hinge;
using test::measured_segment;
using test::three_signals;

const DhLeaf pair_mount{.theta = 0.7, .d = 0.2, .alpha = -1.1, .a = 0.5}, pair_end{.theta = -1.9, .d = 0.15, .a = 0.3};

/// Two segments with a joint of this many rotation axes through one point.
RecordedMotion pair_with_axes(int axes) {
  const DhLeaf turns[] = {{.alpha = 1.4, .theta_signal = 0}, {.alpha = -1.3, .theta_signal = 1}, {.theta_signal = 2}};
  std::vector<DhLeaf> leaves{pair_mount};
  leaves.insert(leaves.end(), turns, turns + axes);
  leaves.push_back(pair_end);
  return test::recorded_motion({measured_segment("parent", freely_moving()),
                                measured_segment("child", propagate(freely_moving(), leaves, three_signals()))});
}

PairFit fitted_pair(const RecordedMotion& motion) {
  return fit_pair(motion, 0, 1, all_rows(motion.rows()));
}

TEST(CodeLength, IsHalfTheLogarithmOfTheDeterminantAndKnowsNoDirection) {
  const Mat3 square = Vec3(0.04, 0.09, 0.16).asDiagonal();
  EXPECT_NEAR(code_length(square, 0.1), 0.5 * std::log(0.05 * 0.10 * 0.17), 1e-12);
  const Mat3 turn = exp_so3(Vec3(0.4, -1.0, 0.3));
  EXPECT_NEAR(code_length(turn * square * turn.transpose(), 0.1), code_length(square, 0.1), 1e-12);
  EXPECT_NEAR(code_length(Mat3::Zero(), 0.01), 3.0 * std::log(0.01), 1e-12) << "the floor alone";
}

TEST(PairFit, FindsTheCentreOfAJoint) {
  for (const int axes : {2, 3}) {
    const PairFit fit = fitted_pair(pair_with_axes(axes));
    EXPECT_LT((fit.point_in_first - transform(pair_mount).position).norm(), 5e-3) << axes;
    EXPECT_LT((fit.point_in_second - transform(pair_end).inverse().position).norm(), 5e-3) << axes;
    EXPECT_LT(fit.residual(), 5e-3) << axes;
    EXPECT_LT(fit.tilt.norm(), 1e-3) << axes;
  }
}

TEST(PairFit, OfARevoluteJointItFindsAPointOfTheAxis) {
  const auto states = propagate(freely_moving(), general_hinge(), three_signals());
  const PairFit fit = fitted_pair(
      test::recorded_motion({measured_segment("parent", freely_moving()), measured_segment("child", states)}));
  for (const double angle : {-0.5, 0.0, 0.4}) {  // the two points coincide at every angle
    const Vec3 in_first = transform(general_hinge(), std::vector{angle}) * fit.point_in_second;
    EXPECT_LT((in_first - fit.point_in_first).norm(), 0.01) << angle;
  }
}

TEST(PairFit, TheHeadingsBehindTheGapsOfASensorAreFound) {
  RecordedMotion motion = pair_with_axes(2);
  const PairFit whole = fitted_pair(motion);
  const double first = motion.time[200], second = motion.time[350];
  turn(motion.segments[1], motion.time, {.steps = {{first, 1.1}, {second, -2.6}}});
  EXPECT_GT(fitted_pair(motion).residual(), 0.5) << "with one heading";
  motion.segments[1].restarts = {first, second};
  const PairFit fit = fitted_pair(motion);
  EXPECT_LT(fit.residual(), 2e-3) << "headings are searched to 1e-4 rad, which is 1e-3 m/s/s of gravity";
  EXPECT_NEAR(fit.distance, whole.distance, 0.1);
  EXPECT_LT((fit.point_in_first - whole.point_in_first).norm(), 2e-3);
  const double begin = fit.heading.at(motion.time.front());
  EXPECT_NEAR(std::remainder(fit.heading.at(first) - begin + 1.1, 2.0 * std::numbers::pi), 0.0, 5e-3);
  EXPECT_NEAR(std::remainder(fit.heading.at(second) - begin - 1.5, 2.0 * std::numbers::pi), 0.0, 5e-3);
}

TEST(PairFit, RatesAreThoseOfTheJoint) {
  const auto states = propagate(freely_moving(), general_hinge(), three_signals());
  const PairFit fit = fitted_pair(
      test::recorded_motion({measured_segment("parent", freely_moving()), measured_segment("child", states)}));
  double square = 0.0;
  for (const double rate : three_signals()[0].angular_velocity) square += rate * rate / 600.0;
  EXPECT_NEAR(fit.relative_rate(), std::sqrt(square), 1e-3);
  EXPECT_LT(fit.off_axis_rate(), 5e-3);
  EXPECT_GT(fitted_pair(pair_with_axes(2)).off_axis_rate(), 0.5) << "the second axis of a universal joint";
}

TEST(PairFit, AJointIsTheNearerTheFewerAxesItHasAndStrangersAreFarthest) {
  std::array<double, 4> distance{};
  for (int axes = 0; axes <= 3; ++axes)
    distance[static_cast<std::size_t>(axes)] = fitted_pair(pair_with_axes(axes)).distance;
  EXPECT_GT(distance[1], distance[0] + 1.0);
  EXPECT_GT(std::min(distance[2], distance[3]), distance[1] + 1.0) << "a hinge beside a wrist";
  const RecordedMotion strangers = test::recorded_motion(
      {measured_segment("parent", freely_moving()), measured_segment("child", freely_moving(1.7))});
  EXPECT_GT(fitted_pair(strangers).distance, std::max(distance[2], distance[3]) + 1.0);
}

TEST(PairFit, ADifferenceOfHeadingsIsFoundAndCostsNothing) {
  const RecordedMotion north = pair_with_axes(1);
  const PairFit reference = fitted_pair(north);
  for (const double heading : {0.5, -2.0, 3.1}) {
    RecordedMotion motion = north;
    test::rotate_world(motion.segments[1], heading);
    const PairFit fit = fitted_pair(motion);
    EXPECT_NEAR(std::remainder(fit.heading.at(3.0) + heading, 2.0 * 3.14159265358979), 0.0, 2e-3) << heading;
    EXPECT_NEAR(fit.distance, reference.distance, 0.05) << heading;
  }
}

TEST(PairFit, HasTheSameDistanceAndPointsFromEitherSide) {
  RecordedMotion motion = pair_with_axes(3);
  const PairFit forward = fitted_pair(motion);
  std::swap(motion.segments[0], motion.segments[1]);
  const PairFit backward = fitted_pair(motion);
  EXPECT_NEAR(forward.distance, backward.distance, 0.1);
  EXPECT_LT((forward.point_in_first - backward.point_in_second).norm(), 5e-3);
  EXPECT_LT((forward.point_in_second - backward.point_in_first).norm(), 5e-3);
}

TEST(PairFit, AnAccelerometerBiasIsNotTakenForALeverArm) {
  RecordedMotion motion = pair_with_axes(3);
  const Vec3 bias(0.2, -0.1, 0.15);
  SegmentMotion& child = motion.segments[1];
  for (std::size_t row = 0; row < motion.rows(); ++row) child.acceleration[row] += child.rotation[row] * bias;
  const PairFit fit = fitted_pair(motion);
  EXPECT_LT((fit.bias_of_second + bias).norm(), 0.03);
  EXPECT_LT(fit.bias_of_first.norm(), 0.03);
  EXPECT_LT((fit.point_in_second - transform(pair_end).inverse().position).norm(), 0.01);
}

TEST(PairFit, TheResidualIsTheNoiseOfBothAccelerometers) {
  RecordedMotion motion = pair_with_axes(2);
  Rng rng(3);
  constexpr double noise = 0.05;  // [m/s²] per axis and sensor
  for (SegmentMotion& segment : motion.segments)
    for (Vec3& a : segment.acceleration)
      for (double& value : a) value += noise * rng.normal();
  EXPECT_NEAR(fitted_pair(motion).residual(), noise * std::sqrt(6.0), 0.05 * noise * std::sqrt(6.0));
}

TEST(PairFit, AStationarySegmentKeepsItsPointNearItsSensor) {
  const auto states = propagate(test::at_rest(), general_hinge(), three_signals());
  const PairFit fit = fitted_pair(
      test::recorded_motion({measured_segment("base", test::at_rest()), measured_segment("child", states)}));
  EXPECT_LT(fit.point_in_first.norm(), 1e-6) << "nothing depends on it";
  EXPECT_LT(fit.residual(), 0.02);
}

TEST(PairFit, MagnetometersDecideWhereTheMotionDoesNot) {
  // Both rotate about the vertical only and at the same place: any heading explains the specific forces.
  const auto turning = propagate(test::at_rest(), std::vector<DhLeaf>{{.theta_signal = 0}}, three_signals());
  RecordedMotion motion = test::recorded_motion({measured_segment("a", turning), measured_segment("b", turning)});
  const auto fit = [&](HeadingReference reference) { return fit_pair(motion, 0, 1, all_rows(600), reference); };
  EXPECT_NEAR(fit(HeadingReference::magnetometers).heading.angle, 0.0, 1e-3);
  test::rotate_world(motion.segments[1], 0.4);
  const PairFit free = fit(HeadingReference::arbitrary), magnetic = fit(HeadingReference::magnetometers);
  EXPECT_LE(std::abs(magnetic.heading.angle), std::abs(free.heading.angle) + 1e-3) << "north is north";
}

}  // namespace
}  // namespace kinfer
