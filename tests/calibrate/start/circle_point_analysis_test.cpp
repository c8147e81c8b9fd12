// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/start/circle_point_analysis.hpp"

#include <gtest/gtest.h>

#include "kinfer/geometry/random.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

const Vec3 world_base(1.2, -2.5, 0.35);

Chain on_a_stand(Chain chain) {
  chain.base = Frame::from_pose(Pose::from_xyz_rpy(world_base, {0.02, -0.03, 2.3}));
  chain.tool.xyz = Vec3(0, 0, 0.1);
  return chain;
}

/// 13 points of each listed joint over 120°, all others at `rest` (the paper's zero position is a zero vector).
PoseSet sweeps(const Chain& truth, const std::vector<int>& joints, const VectorXd& rest, double sigma, Rng rng) {
  constexpr int points = 13;
  PoseSet set;
  set.joint_names = active_joint_names(truth);
  set.joints.resize(6, static_cast<Eigen::Index>(points * joints.size()));
  int row = 0;
  for (const int joint : joints)
    for (int i = 0; i < points; ++i, ++row) {
      VectorXd q = rest;
      q[joint] += (-60.0 + 10.0 * i) * degree;
      set.joints.col(row) = q;
      const Vec3 noise = normal_vector(rng);
      set.points.push_back({row, -1, forward(truth, q).position + sigma * noise, std::nullopt});
      set.line.push_back(row + 2);
    }
  return set;
}

const VectorXd zero = VectorXd::Zero(6);

void expect_same_frames(const Chain& found, const Chain& truth, double length, double angle) {
  EXPECT_LT((found.base.xyz - truth.base.xyz).norm(), length);
  EXPECT_LT(angle_between(found.base.pose().rotation, truth.base.pose().rotation), angle);
  EXPECT_LT((found.tool.xyz - truth.tool.xyz).norm(), length);
}

TEST(CirclePointAnalysis, ThePapersSweepsOfJoints12And5GiveBaseAndToolLength) {
  const Chain truth = on_a_stand(er20(0.125));
  const auto found = estimate_frames_from_circles(er20(0.125), sweeps(truth, {0, 1, 4}, zero, 0.0, Rng(1)));
  ASSERT_TRUE(found) << found.error().what;
  expect_same_frames(found->chain, truth, 1e-9, 1e-9);
  EXPECT_NEAR(found->tool_length, 0.1, 1e-9);  // radius 225 mm = d6 + zt
  EXPECT_NEAR(found->sweeps[2].radius, 0.225, 1e-9);
  EXPECT_EQ(found->base_joints, (std::array<std::string, 2>{"J1", "J2"}));
  EXPECT_EQ(found->tool_length_source, ToolLengthSource::sweep_radius);
}

TEST(CirclePointAnalysis, ATargetBesideTheFlangesAxisIsFoundWhereThePapersRadiusFails) {
  Chain truth = on_a_stand(er20(0.125));
  truth.tool.xyz = Vec3(0.02, -0.015, 0.1);
  const auto found = estimate_frames_from_circles(er20(0.125), sweeps(truth, {0, 1, 4}, zero, 0.0, Rng(1)));
  ASSERT_TRUE(found) << found.error().what;
  expect_same_frames(found->chain, truth, 1e-9, 1e-9);
  EXPECT_GT(std::abs(found->tool_length - 0.1), 0.5e-3);
}

TEST(CirclePointAnalysis, AnyPostureAndAnyTwoNonParallelAxesSuffice) {
  const Chain truth = on_a_stand(er20(0.125));
  const VectorXd rest = (VectorXd(6) << 0.4, -1.2, 0.3, 0.5, 0.6, -0.2).finished();
  const auto found = estimate_frames_from_circles(er20(0.125), sweeps(truth, {2, 3, 4}, rest, 0.0, Rng(1)));
  ASSERT_TRUE(found) << found.error().what;
  expect_same_frames(found->chain, truth, 1e-8, 1e-8);
}

TEST(CirclePointAnalysis, NegativeJointDirectionsAndReversedSweepsAreHandled) {
  Chain truth = on_a_stand(er20(0.125)), nominal = er20(0.125);
  truth.joints[1].gain = nominal.joints[1].gain = -1.0;
  PoseSet data = sweeps(truth, {0, 1, 4}, zero, 0.0, Rng(1));
  std::vector<int> backwards(data.rows());
  for (std::size_t i = 0; i < backwards.size(); ++i) backwards[i] = static_cast<int>(backwards.size() - 1 - i);
  for (const PoseSet& set : {data, select(data, backwards)}) {
    const auto found = estimate_frames_from_circles(nominal, set);
    ASSERT_TRUE(found) << found.error().what;
    expect_same_frames(found->chain, truth, 1e-9, 1e-9);
  }
}

TEST(CirclePointAnalysis, SweepsThereAndBackHaveTheSignOfTheirJoints) {
  const Chain truth = on_a_stand(er20(0.125));
  const PoseSet there = sweeps(truth, {0, 1, 4}, zero, 0.0, Rng(1));
  std::vector<int> there_and_back;
  for (int sweep = 0; sweep < 3; ++sweep) {
    for (int i = 0; i < 13; ++i) there_and_back.push_back(13 * sweep + i);
    for (int i = 12; i-- > 0;) there_and_back.push_back(13 * sweep + i);
  }
  PoseSet data = select(there, there_and_back);
  data.sweeps = {"first", "second", "third"};
  for (int row = 0; row < data.rows(); ++row) data.sweep.push_back(row / 25);
  const auto found = estimate_frames_from_circles(er20(0.125), data);
  ASSERT_TRUE(found) << found.error().what;
  expect_same_frames(found->chain, truth, 1e-9, 1e-9);
}

TEST(CirclePointAnalysis, MarkedSweepsTakePrecedenceAndAMarkOnTwoJointsIsRefused) {
  const Chain truth = on_a_stand(er20(0.125));
  PoseSet data = sweeps(truth, {0, 1}, zero, 0.0, Rng(1));
  data.sweeps = {"first", "second"};
  for (int row = 0; row < 26; ++row) data.sweep.push_back(row / 13);
  const auto marked = find_sweeps(data);
  ASSERT_TRUE(marked);
  EXPECT_EQ((*marked)[1].name, "second");
  EXPECT_EQ((*marked)[1].q_index, 1);
  data.sweep[3] = 1;
  EXPECT_EQ(find_sweeps(data).error().what, "sweep second moves 2 joints; expected one joint alone");
}

TEST(CirclePointAnalysis, ParallelAxesAloneDoNotDetermineTheBase) {
  const Chain truth = on_a_stand(er20(0.125));
  const auto found = estimate_frames_from_circles(er20(0.125), sweeps(truth, {1, 2}, zero, 0.0, Rng(1)));
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().what.find("not parallel"), std::string::npos);
}

TEST(CirclePointAnalysis, StatedUncertaintyIsThatOfRepeatedMeasurements) {
  const Chain truth = on_a_stand(er20(0.125));
  constexpr double sigma = 50e-6;
  constexpr int repetitions = 300;
  const PoseSet exact = sweeps(truth, {0}, zero, 0.0, Rng(1));
  const Sweep sweep = find_sweeps(exact)->front();
  const SweepCircle true_circle = fit_sweep(truth, exact, sweep);
  std::vector<double> radius, stated_radius, worst_tilt, stated_tilt;
  for (int i = 0; i < repetitions; ++i) {
    const SweepCircle circle = fit_sweep(truth, sweeps(truth, {0}, zero, sigma, Rng(2).stream(i)), sweep);
    radius.push_back(circle.radius - true_circle.radius);
    stated_radius.push_back(circle.radius_sd);
    stated_tilt.push_back(circle.axis_sd);
    worst_tilt.push_back(angle_between(circle.axis, true_circle.axis));
  }
  EXPECT_NEAR(standard_deviation(radius), rms(stated_radius), 0.15 * rms(stated_radius));
  // The tilt has two directions; the larger is stated: their root sum of squares lies between 1 and √2 of it.
  EXPECT_GT(rms(worst_tilt), 0.85 * rms(stated_tilt));
  EXPECT_LT(rms(worst_tilt), 1.15 * std::sqrt(2.0) * rms(stated_tilt));
}

TEST(CirclePointAnalysis, WithTrackerNoiseTheBaseIsAsAccurateAsStated) {
  const Chain truth = on_a_stand(er20(0.125));
  const auto found = estimate_frames_from_circles(er20(0.125), sweeps(truth, {0, 1, 4}, zero, 10e-6, Rng(3)));
  ASSERT_TRUE(found);
  expect_same_frames(found->chain, truth, 0.2e-3, 1e-4);
  EXPECT_LT(found->base_differs, 0.3e-3);  // and agrees with the initial frames of calibrate
}

}  // namespace
}  // namespace kinfer
