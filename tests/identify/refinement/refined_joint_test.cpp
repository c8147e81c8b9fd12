// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/joints/refined_joint.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "identify/hand_moved_chain.hpp"
#include "identify/measured_segments.hpp"
#include "kinfer/identify/refinement/fits/clock_fit.hpp"
#include "kinfer/identify/refinement/fits/refinement_setup.hpp"
#include "kinfer/identify/refinement/joints/joint_trajectory.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;
using test::random_vector;

InsBody random_revolute(std::uint64_t seed) {
  Rng rng(seed);
  InsBody body = test::random_revolute_body(0, 1, rng);
  body.point_in_parent = random_vector(rng);
  body.point_in_child = random_vector(rng);
  return body;
}

/// Isotropic: `turn` [rad] for every rotation, `shift` [m] for every point.
MatrixXd isotropic(const InsBody& body, double turn, double shift) {
  VectorXd variance(body.unknowns());
  variance << VectorXd::Constant(body.turns(), turn * turn),
      VectorXd::Constant(body.unknowns() - body.turns(), shift * shift);
  return variance.asDiagonal();
}

RefinedJoint refined_body(const InsBody& body, const MatrixXd& covariance, double zero = 0.0) {
  return refined_joint(EstimatedJointType::revolute, {&body, 1}, {&zero, 1}, covariance);
}

TEST(RefinedJoint, IsotropicErrorsGiveTheSameDeviationInEveryDirection) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const InsBody body = random_revolute(seed);
    const JointStandardDeviation sd = refined_body(body, isotropic(body, 2e-3, 5e-3)).estimate.sd;
    for (const auto& pair : {sd.axis_in_parent, sd.axis_in_child})
      for (const double value : pair) EXPECT_NEAR(value, 2e-3, 1e-12);
    const double along =
        body.child_R_axis.col(2).dot(body.point_in_child);  // the points stated lie beside the unknowns
    for (const auto& pair : {sd.point_in_parent, sd.point_in_child})
      for (const double value : pair) EXPECT_NEAR(value, std::hypot(5e-3, 2e-3 * along), 1e-12);
    EXPECT_NEAR(refined_body(body, isotropic(body, 0.0, 5e-3)).estimate.sd.along_axis, 5e-3 * std::sqrt(2.0), 1e-12);
  }
}

TEST(RefinedJoint, TheLargestCoordinateOfItsAxisIsPositive) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const InsBody body = random_revolute(seed);
    InsBody reversed = body;  // the same joint, its angle counted the other way
    reversed.parent_R_axis = body.parent_R_axis * rot_x(3.14159265358979323846);
    reversed.child_R_axis = body.child_R_axis * rot_x(3.14159265358979323846);
    const JointEstimate one = refined_body(body, isotropic(body, 1e-3, 1e-3)).estimate,
                        other = refined_body(reversed, isotropic(reversed, 1e-3, 1e-3)).estimate;
    EXPECT_LT((one.axis_in_parent - other.axis_in_parent).norm(), 1e-12);
    EXPECT_LT((one.axis_in_child - other.axis_in_child).norm(), 1e-12);
    Index largest = 0;
    one.axis_in_parent.cwiseAbs().maxCoeff(&largest);
    EXPECT_GT(one.axis_in_parent[largest], 0.0);
  }
}

TEST(RefinedJoint, AKnownMachinesAxisKeepsItsSenseThoughItsParentSaysLittleOfIt) {
  const InsBody body = random_revolute(3);
  const Vec3 in_parent = body.parent_R_axis.col(2), in_child = body.child_R_axis.col(2);
  for (const double sense : {1.0, -1.0}) {
    EXPECT_EQ(axis_sense(body, PositiveAxis{sense * in_parent, sense * in_child}), sense);
    EXPECT_EQ(axis_sense(body, PositiveAxis{-0.9 * sense * in_parent, sense * in_child}), sense);
  }
}

TEST(RefinedJoint, ItsPointsAreNearestToTheChildsSensorAndCoincide) {
  const InsBody body = random_revolute(3);
  const RefinedJoint joint = refined_body(body, isotropic(body, 1e-3, 1e-3), 0.7);
  const JointGeometry& g = joint.solution.geometry;
  EXPECT_NEAR(g.point_in_child.dot(g.axis_in_child), 0.0, 1e-12);
  EXPECT_LT((g.home * g.point_in_child - g.point_in_parent).norm(), 1e-12);
  EXPECT_LT((g.home.rotation * g.axis_in_child - g.axis_in_parent).norm(), 1e-12);
}

TEST(RefinedJoint, DhDeviationsAreTheScatterOfRandomlyMovedBodies) {
  const InsBody body = random_revolute(4);
  MatrixXd root = 1e-3 * test::random_matrix(body.unknowns(), body.unknowns(), 9);
  const std::vector<DhNumbers> stated = refined_body(body, root * root.transpose()).solution.precision.canonical_sd;
  constexpr int samples = 2000;
  Rng rng(5);
  const auto numbers = [](const std::vector<DhNumbers>& rows) {
    VectorXd all(5 * static_cast<Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i)
      all.segment<5>(5 * static_cast<Index>(i)) << rows[i].theta, rows[i].d, rows[i].alpha, rows[i].a, rows[i].beta;
    return all;
  };
  const auto rows_of = [&](const InsBody& moved) {
    return numbers(
        joint_dh_rows(EstimatedJointType::revolute, refined_body(moved, isotropic(moved, 1.0, 1.0)).solution.geometry));
  };
  const VectorXd truth = rows_of(body);
  VectorXd square = VectorXd::Zero(truth.size());
  for (int k = 0; k < samples; ++k) {
    VectorXd step(body.unknowns());
    for (double& value : step) value = rng.normal();
    VectorXd change = rows_of(retract(body, root * step)) - truth;
    for (double& value : change) value = std::remainder(value, 2.0 * 3.14159265358979323846);
    square += change.cwiseAbs2() / samples;
  }
  const VectorXd expected = numbers(stated);
  for (Index i = 0; i < truth.size(); ++i)
    EXPECT_NEAR(std::sqrt(square[i]), expected[i], 0.1 * expected[i] + 1e-9) << i;
}

TEST(RefinedJoint, DeviationsOfAPointAreItsScatterAcrossTheAxis) {
  InsBody body = random_revolute(4);
  body.point_in_parent += 0.8 * body.parent_R_axis.col(2), body.point_in_child += 0.8 * body.child_R_axis.col(2);
  const MatrixXd root = 1e-3 * test::random_matrix(body.unknowns(), body.unknowns(), 9);
  const JointEstimate here = refined_body(body, root * root.transpose()).estimate;
  const Vec3 across = any_perpendicular(here.axis_in_parent).normalized();  // the first direction that has an sd
  double square = 0.0;
  constexpr int samples = 2000;
  Rng rng(5);
  for (int k = 0; k < samples; ++k) {
    VectorXd step(body.unknowns());
    for (double& value : step) value = rng.normal();
    const InsBody moved = retract(body, root * step);
    const Vec3 change = refined_body(moved, isotropic(moved, 1.0, 1.0)).estimate.point_in_parent - here.point_in_parent;
    square += across.dot(change) * across.dot(change) / samples;
  }
  EXPECT_NEAR(std::sqrt(square), here.sd.point_in_parent[0], 0.1 * here.sd.point_in_parent[0]);
}

TEST(RefinedJoint, ADirectionThatTheRecordingDoesNotTellIsListed) {
  const InsBody body = random_revolute(5);
  MatrixXd covariance = isotropic(body, 1e-3, 1e-3);
  const Vec3 hidden = Vec3(1.0, 2.0, -1.0).normalized();
  covariance.block<3, 3>(7, 7) += 4.0 * hidden * hidden.transpose();  // of the point in the child
  const JointEstimate joint = refined_body(body, covariance).estimate;
  EXPECT_TRUE(joint.unobservable_in_parent.empty());
  ASSERT_EQ(joint.unobservable_in_child.size(), 1U);
  EXPECT_GT(std::abs(joint.unobservable_in_child[0].dot(hidden)), 0.999999);
}

TEST(RefinedJoint, APointThatIsOnlyConfoundedWithAnotherParameterIsObservable) {
  const InsBody body = random_revolute(6);
  MatrixXd covariance = isotropic(body, 1e-3, 1e-3);
  VectorXd together = VectorXd::Zero(body.unknowns());  // both points move along the axis
  together.segment<3>(4) = body.parent_R_axis.col(2), together.segment<3>(7) = body.child_R_axis.col(2);
  covariance += 4.0 * together * together.transpose();
  const JointEstimate joint = refined_body(body, covariance).estimate;
  EXPECT_TRUE(joint.unobservable_in_parent.empty());
  EXPECT_TRUE(joint.unobservable_in_child.empty());
  EXPECT_LT(joint.sd.along_axis, 5e-3) << "the shift of one against the other";
}

TEST(RefinedJoint, APrismaticJointStartsAtItsZero) {
  Rng rng(7);
  InsBody body = test::random_prismatic_body(0, 1, rng);
  body.point_in_parent = random_vector(rng);
  const double zero = 0.4;
  const MatrixXd covariance = isotropic(body, 1e-3, 2e-3);
  const RefinedJoint joint = refined_joint(EstimatedJointType::prismatic, {&body, 1}, {&zero, 1}, covariance);
  EXPECT_LT((joint.estimate.point_in_parent - body.point_in_parent - zero * body.parent_R_axis.col(2)).norm(), 1e-12);
  EXPECT_EQ(joint.estimate.point_in_child.norm(), 0.0) << "the axis passes through the child's sensor";
  EXPECT_NEAR(joint.estimate.sd.point_in_parent[0], std::hypot(2e-3, zero * 1e-3), 1e-12);
  EXPECT_NEAR(joint.estimate.sd.along_axis, 2e-3, 1e-12);
}

TEST(RefinedJoint, ARigidPairKeepsTheMountingOfItsSensors) {
  Rng rng(8);
  const Mat3 parent_R_child = exp_so3(random_vector(rng));
  InsBody body = fixed_body(0, 1, parent_R_child);
  body.point_in_parent = random_vector(rng);
  const double zero = 0.0;
  const RefinedJoint joint =
      refined_joint(EstimatedJointType::rigid, {&body, 1}, {&zero, 1}, isotropic(body, 1e-3, 2e-3));
  EXPECT_LT((joint.solution.geometry.home.rotation - parent_R_child).norm(), 1e-12);
  EXPECT_LT((joint.solution.geometry.home.position - body.point_in_parent).norm(), 1e-12);
}

TEST(TrajectoryFrames, AreAtMostSixHundredAndBeginWithTheRecording) {
  for (const std::size_t rows : {1U, 600U, 601U, 100000U}) {
    RecordedMotion motion;
    for (std::size_t row = 0; row < rows; ++row) motion.time.push_back(5.0 + 0.01 * static_cast<double>(row));
    const std::vector<double> times = trajectory_times(motion);
    EXPECT_LE(times.size(), 600U);
    EXPECT_EQ(times.size(), trajectory_frames(motion).count()) << rows;
    EXPECT_EQ(times.front(), 5.0);
    EXPECT_LE(times.back(), motion.time.back());
    EXPECT_TRUE(rows > 600 || times.size() == rows) << "a short recording keeps every row";
  }
}

/// Measurements of one interval with this rotation rate [rad/s].
InsMeasurements rotating_at(double rate, const SplineGrid& grid) {
  InsSensor sensor{.name = "s", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  std::vector<double> time;
  for (double t = 0.0; t < grid.end(); t += 0.01) {
    time.push_back(t);
    for (auto& axis : sensor.angular_velocity.axis) axis.push_back(static_cast<float>(rate));
    for (auto& axis : sensor.acceleration.axis) axis.push_back(1.0f);
    sensor.faults.push_back(0);
  }
  InsMeasurements measurements;
  measurements.angular_velocity = ins_blocks(sensor, time, InsInstrument::gyroscope, grid);
  return measurements;
}

TEST(FreeClocks, AreRelativeToTheSensorThatRotatesMost) {
  InsProblem problem;
  problem.grid = {0.0, 0.1, 10};
  for (const double rate : {0.1, -0.8, 0.3}) problem.sensors.push_back(rotating_at(rate, problem.grid));
  EXPECT_FALSE(layout_of(problem, {{.sensor = 0}}).has_clocks);
  free_clocks(problem, {{.sensor = 0}, {.sensor = 2}});
  EXPECT_EQ(problem.clock_reference, 2U) << "sensor 1 is outside of the chain";
  free_clocks(problem, {{.sensor = 0}, {.sensor = -1}, {.sensor = 1}, {.sensor = 2}});
  EXPECT_EQ(problem.clock_reference, 1U);
  EXPECT_TRUE(layout_of(problem, {{.sensor = 0}}).has_clocks);
  InsFit fit;
  EXPECT_TRUE(refined_clocks(problem, fit, {}).empty()) << "a fit without free clocks";
}

TEST(Clocks, DifferWhereTheyDoAtSomeTimeOfTheRecording) {
  const SplineGrid three_minutes{10.0, 0.1, 1800};
  InsUnknowns x;
  x.errors.resize(2);
  EXPECT_FALSE(clocks_differ(three_minutes, x));
  x.errors[1].clock = {.offset = 0.5e-3, .drift = 0.0};
  EXPECT_FALSE(clocks_differ(three_minutes, x));
  x.errors[1].clock = {.offset = -2e-3, .drift = 0.0};
  EXPECT_TRUE(clocks_differ(three_minutes, x));
  x.errors[1].clock = {.offset = 0.0, .drift = -50e-6};
  EXPECT_TRUE(clocks_differ(three_minutes, x)) << "by 4.5 ms at both ends";
  EXPECT_FALSE(clocks_differ({10.0, 0.1, 100}, x));
}

/// The start of the fit of the hand-moved chain, from its true joint types.
RefinementSetup chain_setup(const test::HandMovedChain& chain, const OrderedMotion& ordered) {
  std::vector<InitialJoint> starts;
  for (std::size_t i = 1; i < ordered.tree.order.size(); ++i)
    starts.push_back(estimate_initial_joint(ordered.motion, ordered.tree, *ordered.tree.parent[ordered.tree.order[i]],
                                            ordered.tree.order[i],
                                            i == 1 ? EstimatedJointType::revolute : EstimatedJointType::universal));
  return set_up_refinement(chain.recording, ordered.motion, ordered.tree, starts, *sensor_grade("industrial"), 0.04);
}

TEST(RefinementSetup, OfAMovingRootBeginsWithWhatItsOwnSensorMeasures) {
  const test::HandMovedChain chain(0.0);
  const auto ordered = order_segments(chain.recording, {}, "a", 0);
  ASSERT_TRUE(ordered);
  const RefinementSetup setup = chain_setup(chain, *ordered);
  EXPECT_FALSE(setup.problem.root_at_rest);
  EXPECT_EQ(setup.first_body, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(setup.last_body, (std::vector<std::size_t>{1, 3})) << "a universal joint has two bodies";
  EXPECT_EQ(setup.problem.anchor.size(), 3U);
  ASSERT_EQ(setup.start.spline_coefficients.rows(), 6 + 3);
  EXPECT_EQ(setup.start.bodies[3].parent, 2);
  double rate_error = 0.0, force_error = 0.0;
  int times = 0;
  for (double t = 3.0; t < 27.0; t += 0.5, ++times) {
    const VectorXd spline = spline_value(setup.problem.grid, setup.start.spline_coefficients, t);
    const InsState root = chain.states_at(t)[0];
    rate_error += (spline.head<3>() - root.angular_velocity).squaredNorm();
    force_error += (spline.segment<3>(3) - root.force).squaredNorm();
  }
  EXPECT_LT(std::sqrt(rate_error / times), 0.3) << "smoothed, as the motion of the segments is";
  EXPECT_LT(std::sqrt(force_error / times), 0.3);
}

TEST(RefinementSetup, GravityOfTheRecordingIsNotAssumedToBeStandard) {
  const test::HandMovedChain chain(0.0);
  SegmentMotionOptions options;
  options.gravity = 9.7;
  const auto standard = order_segments(chain.recording, {}, "a", 0),
             other = order_segments(chain.recording, options, "a", 0);
  ASSERT_TRUE(standard && other);
  const MatrixXd one = chain_setup(chain, *standard).start.spline_coefficients.topRows(6),
                 two = chain_setup(chain, *other).start.spline_coefficients.topRows(6);
  EXPECT_LT((one - two).cwiseAbs().maxCoeff(), 0.02) << "the sensor measures the same specific force";
}

}  // namespace
}  // namespace kinfer
