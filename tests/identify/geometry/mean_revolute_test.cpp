// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/geometry/mean_revolute.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "identify/hand_moved_chain.hpp"
#include "kinfer/estimate/continuous/model/interval_motion.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;
using test::HandMovedChain;
using test::refined;
using test::wave;

double across(const Vec3& error, const Vec3& axis) {
  return (error - axis * axis.dot(error)).norm();
}

TEST(MeanRevolute, AnImperfectRevoluteJointOnAShakenChainIsIdentifiedWithItsLevers) {
  const HandMovedChain chain;
  const Refinement found = refined(chain.recording, 0);
  ASSERT_EQ(found.joints.size(), 2u);
  EXPECT_GT(found.cutoff, 0.0);
  const RefinedJoint &sound = found.joints[0], &loose = found.joints[1];
  ASSERT_TRUE(loose.mean);
  EXPECT_NEAR(loose.mean->axis_deviation, 0.05, 0.01);
  EXPECT_LT(sound.mean ? sound.mean->axis_deviation : 0.0, 0.01);
  EXPECT_EQ(loose.estimate.type, EstimatedJointType::revolute);
  const Vec3 axis = Vec3::UnitX();  // of the imperfect joint, in the parent
  EXPECT_LT(loose.estimate.axis_in_parent.cross(axis).norm(), 0.02);
  EXPECT_LT(across(loose.estimate.point_in_parent - chain.bodies[2].point_in_parent, axis), 2e-3);
  const Vec3 in_child = chain.bodies[2].child_R_axis * axis;
  EXPECT_LT(across(loose.estimate.point_in_child - chain.bodies[2].point_in_child, in_child), 2e-3);
  const Vec3 other = chain.bodies[1].parent_R_axis.col(2);
  const double lever = across(sound.estimate.point_in_parent - chain.bodies[1].point_in_parent, other);
  EXPECT_LT(lever, 4e-3);
  EXPECT_LT(lever, 2.5 * std::hypot(sound.estimate.sd.point_in_parent[0], sound.estimate.sd.point_in_parent[1]));
  EXPECT_LT(sound.estimate.axis_in_parent.cross(other).norm(), 0.01);
}

TEST(MeanRevolute, TheRelaxedJointMovesTheSame) {
  Rng rng(2);
  InsProblem problem;
  problem.grid = {0.0, 0.1, 10};
  problem.sensors.resize(3);
  InsUnknowns x;
  x.bodies = {{.sensor = 0},
              revolute_body(0, 1, exp_so3(Vec3(0.3, -0.2, 0.1)), exp_so3(Vec3(0.1, 0.5, -0.4))),
              revolute_body(1, 2, exp_so3(Vec3(-0.3, 0.2, 0.7)), exp_so3(Vec3(0.4, 0.1, 0.2)))};
  for (std::size_t b = 1; b < 3; ++b) {
    x.bodies[b].point_in_parent = Vec3(0.3, 0.1, 0.2);
    x.bodies[b].point_in_child = Vec3(-0.2, 0.2, 0.1);
  }
  x.root_force = Vec3(1.0, 2.0, 9.0);
  x.errors.resize(3);
  x.spline_coefficients.resize(2, problem.grid.coefficients());
  for (Index i = 0; i < x.spline_coefficients.size(); ++i) x.spline_coefficients.data()[i] = rng.normal();
  const InsLayout layout = layout_of(problem, x.bodies);
  InsUnknowns ball = x;
  relax_to_spherical(ball, layout, 1);
  const InsLayout loose = layout_of(problem, ball.bodies);
  for (const double u : {0.1, 0.7}) {
    const auto is = body_states(problem, loose, ball, 3, spline_basis(u, 0.1)),
               ought = body_states(problem, layout, x, 3, spline_basis(u, 0.1));
    for (std::size_t b = 1; b < 3; ++b) {
      EXPECT_LT((is[b].angular_velocity - ought[b].angular_velocity).norm(), 1e-9);
      EXPECT_LT((is[b].force - ought[b].force).norm(), 1e-7);
    }
  }
}

TEST(MeanRevolute, TheAxisIsTheMeanDirectionAndTheDeviationItsScatter) {
  const Vec3 a = Vec3(1.0, 0.2, -0.1).normalized(), b = Vec3(0.3, 1.0, 0.2).normalized();
  const Mat3 in_parent = frame_with_z_along(a), in_child = frame_with_z_along(b);
  std::vector<Mat3> rotations;
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.02 * i;
    const Vec3 axis_deviation(wave(0.04, 0.9, 0.0, t)[0], wave(0.04, 1.1, 1.0, t)[0], 0.0);
    rotations.push_back(in_parent * exp_so3(axis_deviation) * rot_z(wave(1.0, 0.2, 0.5, t)[0]) * in_child.transpose());
  }
  const MeanRevolute hinge =
      fit_mean_revolute(spherical_body(0, 1, Mat3::Identity()), rotations, MatrixXd::Identity(6, 6), 1e-3);
  EXPECT_LT(hinge.body.parent_R_axis.col(2).cross(a).norm(), 0.004);
  EXPECT_LT(hinge.body.child_R_axis.col(2).cross(b).norm(), 0.004);
  EXPECT_NEAR(hinge.axis_deviation, 0.04, 0.003);
  EXPECT_GT(std::sqrt(hinge.covariance(0, 0)), 1e-3);
  EXPECT_LT(std::sqrt(hinge.covariance(0, 0)), 0.015);
}

TEST(MeanRevolute, TheLowFrequencyFitIsTheSameForAnyNumberOfThreads) {
  HandMovedChain chain;
  chain.recording.loggers[0].time.resize(400);
  for (InsSensor& sensor : chain.recording.sensors) {
    for (std::size_t k = 0; k < 3; ++k)
      sensor.angular_velocity.axis[k].resize(400), sensor.acceleration.axis[k].resize(400);
    sensor.faults.resize(400);
  }
  const Refinement one = refined(chain.recording, 1);
  EXPECT_GT(one.cutoff, 0.0);
  for (const int threads : {2, 7}) {
    const Refinement many = refined(chain.recording, threads);
    for (std::size_t i = 0; i < one.joints.size(); ++i) {
      EXPECT_EQ(one.joints[i].estimate.point_in_parent, many.joints[i].estimate.point_in_parent);
      EXPECT_EQ(one.joints[i].estimate.sd.point_in_child, many.joints[i].estimate.sd.point_in_child);
    }
  }
}

}  // namespace
}  // namespace kinfer
