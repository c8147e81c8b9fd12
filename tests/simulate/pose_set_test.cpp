// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/pose_set.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "support/robots.hpp"

namespace kinfer {
namespace {

using test::er20;

TEST(SimulatedPoints, WithoutNoiseAreTheToolPositions) {
  const Chain chain = test::with_table3_errors(er20());
  const MatrixXd joints = simulate_pose_set(chain, {.poses = 7}, Rng(3)).value().joints;
  const PoseSet set = simulate_points(chain, joints);
  ASSERT_EQ(set.points.size(), 7u);
  EXPECT_EQ(set.joint_names, active_joint_names(chain));
  for (const PointMeasurement& point : set.points)
    EXPECT_LT((point.position - forward(chain, joints.col(point.row)).position).norm(), 1e-15);
  EXPECT_EQ(set.line.front(), 2) << "after the header of a file";
}

TEST(SimulatedPoints, HaveTheNoiseOfTheInstrument) {
  const Chain chain = er20();
  const Instrument instrument{.sigma = 1e-3, .ppm = 500.0};
  const PoseSet set = simulate_pose_set(chain, {.poses = 2000, .instrument = instrument}, Rng(4)).value();
  std::vector<double> normalised;
  for (const PointMeasurement& point : set.points) {
    const Vec3 truth = forward(chain, set.joints.col(point.row)).position;
    for (const double error : point.position - truth) normalised.push_back(error / position_sd(instrument, truth));
  }
  EXPECT_NEAR(mean(normalised), 0.0, 4 / std::sqrt(6000.0));
  EXPECT_NEAR(standard_deviation(normalised), 1.0, 4 / std::sqrt(12000.0));
}

TEST(SimulatedPoses, LieWithinLimitsAndInTheGivenSpace) {
  Chain chain = er20();
  chain.base = Frame::from_pose(Pose::from_xyz_rpy({1, 2, 3}, {0.1, 0.2, 0.3}));
  const PoseSimulation simulation{.poses = 200, .space = {.lowest = 0.2, .clearance = 0.5}, .instrument = {}};
  const PoseSet set = simulate_pose_set(chain, simulation, Rng(5)).value();
  for (int row = 0; row < 200; ++row) {
    const Vec3 in_base = chain.base.pose().inverse() * forward(chain, set.joints.col(row)).position;
    EXPECT_GT(in_base.z(), 0.2);
    EXPECT_GT(in_base.head<2>().norm(), 0.5);
    for (int j = 0; j < 6; ++j) {
      EXPECT_GE(set.joints(j, row), chain.joints[j].lower);
      EXPECT_LE(set.joints(j, row), chain.joints[j].upper);
    }
  }
}

TEST(SimulatedPoses, OfTheSameSeedAreTheSameAndDoNotDependOnTheirNumber) {
  const Chain chain = er20();
  const PoseSet few = simulate_pose_set(chain, {.poses = 5}, Rng(6)).value(),
                many = simulate_pose_set(chain, {.poses = 50}, Rng(6)).value(),
                other = simulate_pose_set(chain, {.poses = 5}, Rng(7)).value();
  EXPECT_EQ(few.joints, many.joints.leftCols(5));
  EXPECT_EQ(few.points[4].position, many.points[4].position);
  EXPECT_NE(few.joints, other.joints);
}

TEST(SimulatedPoses, MeasureOrientationsWhereTheInstrumentDoes) {
  const Chain chain = er20();
  const PoseSimulation simulation{.poses = 500, .instrument = {.sigma_angle = 2e-3}, .measured = Measured::poses};
  const PoseSet set = simulate_pose_set(chain, simulation, Rng(8)).value();
  ASSERT_EQ(set.orientations.size(), 500u);
  std::vector<double> angles;
  for (const OrientationMeasurement& turn : set.orientations)
    angles.push_back(
        angle_between(turn.orientation.toRotationMatrix(), forward(chain, set.joints.col(turn.row)).rotation));
  EXPECT_NEAR(rms(angles), 2e-3 * std::sqrt(3.0), 0.2e-3);
}

TEST(SimulatedPoses, OfAShakingStandHaveTheErrorsThatTheirCovarianceSays) {
  const Chain chain = er20();
  const PoseSimulation simulation{
      .poses = 1500, .instrument = {.sigma = 1e-4, .sigma_angle = 1e-4}, .measured = Measured::poses, .shake = 1e-3};
  const PoseSet set = simulate_pose_set(chain, simulation, Rng(9)).value();
  double squares = 0.0, turns = 0.0;
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    const Pose truth = forward(chain, set.joints.col(set.points[i].row));
    const Mat3 covariance = covariance_of(*set.points[i].sd, set.points[i].axes);
    const Vec3 off = set.points[i].position - truth.position;
    squares += off.dot(covariance.inverse() * off);
    const Vec3 turn = log_so3(set.orientations[i].orientation.toRotationMatrix() * truth.rotation.transpose());
    turns += turn.cwiseQuotient(*set.orientations[i].sd).squaredNorm();
    EXPECT_TRUE(set.orientations[i].covariance_with_point);
  }
  EXPECT_NEAR(squares / 1500, 3.0, 0.3);
  EXPECT_NEAR(turns / 1500, 3.0, 0.3);
}

TEST(SimulatedPoses, WhatCannotBeIsSaid) {
  const Chain chain = er20();
  const auto nowhere = simulate_pose_set(chain, {.poses = 1, .space = {.lowest = 100.0}}, Rng(1));
  EXPECT_EQ(nowhere.error().what,
            "none of 10000 random poses keeps the tool above 100 m and 0 m away from the base axis");
  const auto perfect = simulate_pose_set(chain, {.poses = 1, .instrument = {}, .shake = 1e-3}, Rng(1));
  EXPECT_NE(perfect.error().what.find("a shaking stand needs an instrument"), std::string::npos);
}

TEST(SimulatedPoses, JointsWithoutLimitsStayInTheirUsualRange) {
  Chain chain = er20();
  for (Joint& joint : chain.joints) joint.lower = -INFINITY, joint.upper = INFINITY;
  chain.joints[2].type = JointType::prismatic;
  const MatrixXd joints = simulate_pose_set(chain, {.poses = 300}, Rng(2)).value().joints;
  EXPECT_GE(joints.row(2).minCoeff(), 0.0);
  EXPECT_LE(joints.row(2).maxCoeff(), 0.3);
  EXPECT_LE(joints.cwiseAbs().maxCoeff(), 170.0 * degree);
  EXPECT_GT(joints.cwiseAbs().maxCoeff(), 160.0 * degree);
}

TEST(RandomErrors, HaveTheSizeOfTheTolerancesAndSpareExactGains) {
  const Chain nominal = er20();
  const Tolerances tolerances;
  std::vector<double> normalised;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const Chain truth = with_random_errors(nominal, tolerances, Rng(1).stream(k));
    for (const Parameter& p : all_parameters(nominal, tolerances).parameters) {
      const double error = value_at(truth, p.at) - p.nominal;
      if (p.name.starts_with("gain") || p.name.starts_with("compliance"))
        EXPECT_EQ(error, 0.0) << p.name;
      else
        normalised.push_back(error / p.prior_sd);
    }
  }
  EXPECT_NEAR(mean(normalised), 0.0, 4 / std::sqrt(double(normalised.size())));
  EXPECT_NEAR(standard_deviation(normalised), 1.0, 4 / std::sqrt(2.0 * double(normalised.size())));
}

}  // namespace
}  // namespace kinfer
