// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/inverse.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <set>

#include "laws/example_chains.hpp"

namespace kinfer {

namespace {

/// Two links of 1 m in the world's xy plane.
Chain planar() {
  Chain chain;
  chain.joints = {laws::revolute<DhLink>(1, 0, 0), laws::revolute<DhLink>(1, 0, 0)};
  chain.joints[1].parent = 0;
  return chain;
}

VectorXd readings(double a, double b) {
  return (VectorXd(2) << a, b).finished();
}

void expect_reached(const Chain& chain, const Pose& target, const InverseSolution& s, const Load& load = {}) {
  EXPECT_EQ(s.status, InverseStatus::reached) << chain.name;
  const Pose pose = forward(chain, s.q, load);
  EXPECT_LT((pose.position - target.position).norm(), 1.01e-9);
  EXPECT_LT(angle_between(pose.rotation, target.rotation), 1.01e-9);
}

TEST(Inverse, APoseNearTheStartIsReachedInAFewSteps) {
  for (const Chain& chain : {laws::dh_6r(), laws::er20_with_errors(), laws::coupled(), laws::seven_r()}) {
    for (std::uint64_t k = 0; k < 50; ++k) {
      const VectorXd truth = laws::random_q(chain, Rng(8).stream(k));
      VectorXd start = truth;
      for (double& reading : start) reading += 0.01;
      const Pose target = forward(chain, truth);
      const InverseSolution s = inverse(chain, target, start);
      expect_reached(chain, target, s);
      EXPECT_LE(s.iterations, 25);
    }
  }
}

TEST(Inverse, AFarPoseIsMostlyReachedAndTheStatusIsTrue) {
  const Chain chain = laws::er20();
  int reached = 0;
  for (std::uint64_t k = 0; k < 100; ++k) {
    const Pose target = forward(chain, laws::random_q(chain, Rng(9).stream(k)));
    const InverseSolution s = inverse(chain, target, laws::random_q(chain, Rng(10).stream(k)));
    const Pose pose = forward(chain, s.q);
    EXPECT_NEAR((pose.position - target.position).norm(), s.position_error, 1e-12);
    if (s.status != InverseStatus::reached) continue;
    ++reached;
    expect_reached(chain, target, s);
  }
  EXPECT_GE(reached, 60);
}

TEST(Inverse, TheDeflectedToolReachesThePoseUnderLoad) {
  const Chain chain = laws::compliant();
  const Load load{.payload = 20.0};
  const VectorXd truth = (VectorXd(6) << 0.2, -0.8, 0.7, 0.4, 0.9, -0.3).finished();
  Chain rigid = chain;
  for (Joint& joint : rigid.joints) joint.compliance = 0.0;
  const Pose target = forward(rigid, truth);  // where the rigid machine would be
  const InverseSolution s = inverse(chain, target, truth, {}, load);
  expect_reached(chain, target, s, load);
  EXPECT_GT((s.q - truth).norm(), 1e-4);
}

TEST(Inverse, APositionAloneIsReachedByMachinesOfFewJoints) {
  for (const Chain& chain : {laws::scara(), laws::seven_r(), laws::two_arms()}) {
    VectorXd truth = VectorXd::Constant(dof(chain), 0.1);
    truth[1] = 0.9;
    const Vec3 target = forward(chain, truth).position;
    VectorXd start = truth;
    for (double& reading : start) reading += 0.05;
    const InverseSolution s = inverse_position(chain, target, start);
    EXPECT_EQ(s.status, InverseStatus::reached) << chain.name;
    EXPECT_LT((forward(chain, s.q).position - target).norm(), 1.01e-9);
    EXPECT_EQ(s.angle_error, 0.0);
  }
}

TEST(Inverse, APointBeyondTheReachIsMissedByTheDistanceToTheWorkspace) {
  const InverseSolution s = inverse_position(planar(), {0, 3, 0}, readings(0.4, 0.5));
  EXPECT_EQ(s.status, InverseStatus::unreachable);
  EXPECT_NEAR(s.position_error, 1.0, 1e-6);
}

TEST(Inverse, APointOffThePlaneIsMissedByItsHeight) {
  const InverseSolution s = inverse_position(planar(), {1.0, 0.8, 0.25}, readings(0.4, 0.5));
  EXPECT_EQ(s.status, InverseStatus::unreachable);
  EXPECT_NEAR(s.position_error, 0.25, 1e-9);
}

TEST(Inverse, ALimitIsKeptAndReported) {
  Chain chain = planar();
  chain.joints[0].lower = -0.1, chain.joints[0].upper = 0.5;
  const InverseSolution s = inverse_position(chain, {-1.2, 1.2, 0}, readings(0.4, 0.5));
  EXPECT_EQ(s.status, InverseStatus::at_limit);
  EXPECT_EQ(s.q[0], 0.5);
}

TEST(Inverse, AStartOutsideTheLimitsIsClamped) {
  Chain chain = planar();
  chain.joints[1].lower = 0.0, chain.joints[1].upper = 2.0;
  const InverseSolution s = inverse_position(chain, {1.0, 1.0, 0}, readings(0.0, -1.0));
  EXPECT_EQ(s.status, InverseStatus::reached);
  EXPECT_GE(s.q[1], 0.0);
}

TEST(Inverse, AStretchedArmReachesAPointOnItsOwnLine) {
  const InverseSolution s = inverse_position(planar(), {1.2, 0, 0}, readings(0.0, 0.0));  // the gradient vanishes here
  EXPECT_EQ(s.status, InverseStatus::reached);
}

TEST(Inverse, APointOnTheRimOfTheWorkspaceIsReached) {
  const InverseSolution s = inverse_position(planar(), {0, 2, 0}, readings(0.4, 0.5));
  EXPECT_EQ(s.status, InverseStatus::reached);
}

TEST(Inverse, AnAlignedWristIsReportedAsNearSingular) {
  Chain chain = laws::er20();
  const VectorXd start = (VectorXd(6) << 0.2, -0.8, 0.7, 0.4, 1e-6, -0.3).finished();
  Pose target = forward(chain, start);
  const Mat3 wrist = joint_frames(chain, start)[3].rotation;
  target.rotation = exp_so3(0.2 * wrist.col(0)) * target.rotation;  // across both of the wrist's axes, which coincide
  const InverseSolution s = inverse(chain, target, start, {.iterations = 1});
  EXPECT_EQ(s.status, InverseStatus::near_singular);
}

TEST(Inverse, AnExhaustedBudgetElsewhereIsReportedAsSuch) {
  const InverseSolution s = inverse_position(planar(), {-1.0, -1.0, 0}, readings(0.4, 0.9), {.iterations = 2});
  EXPECT_EQ(s.status, InverseStatus::iteration_limit);
}

TEST(Inverse, NoTravelOfAPrismaticJointIsTooLong) {
  Chain chain;
  chain.joints = {laws::prismatic<DhLink>(0, 0, 0), laws::revolute<DhLink>(0.5, 0, 0)};
  chain.joints[1].parent = 0;
  for (const double travel : {0.01, 12.0, 1200.0, 1e5}) {
    const VectorXd truth = readings(travel, 0.8);
    const InverseSolution s = inverse(chain, forward(chain, truth), readings(0.0, 0.0));
    EXPECT_EQ(s.status, InverseStatus::reached) << travel << " m";
    EXPECT_LT((s.q - truth).norm(), 1e-8) << travel << " m";
    EXPECT_LE(s.iterations, 40) << travel << " m";
  }
}

TEST(Inverse, APrismaticJointAtItsLimitIsNamed) {
  Chain chain = laws::scara();
  const VectorXd truth = (VectorXd(4) << 0.3, 0.7, 0.35, 0.1).finished();
  const InverseSolution s = inverse(chain, forward(chain, truth), (VectorXd(4) << 0.3, 0.7, 0.1, 0.1).finished());
  EXPECT_EQ(s.status, InverseStatus::at_limit);
  EXPECT_EQ(s.q[2], 0.2);
  EXPECT_NEAR(s.position_error, 0.98 * 0.15, 1e-9);
}

TEST(Inverse, TheWeightOfAnglesDoesNotChangeWhatIsReachable) {
  const Chain chain = laws::dh_6r();
  const VectorXd truth = laws::random_q(chain, Rng(21));
  const VectorXd start = truth.array() + 0.05;
  const Pose target = forward(chain, truth);
  for (const double length : {0.01, 0.3, 1.0, 50.0})
    expect_reached(chain, target, inverse(chain, target, start, {.length = length}));
}

TEST(Inverse, TheWeightOfAnglesDecidesBetweenPlaceAndOrientationOutOfReach) {
  Pose target = forward(planar(), readings(0.4, 0.5));
  target.rotation = rot_z(0.6) * target.rotation;  // two joints cannot have three coordinates
  const InverseSolution place = inverse(planar(), target, readings(0.4, 0.5), {.length = 0.01});
  const InverseSolution turn = inverse(planar(), target, readings(0.4, 0.5), {.length = 100.0});
  EXPECT_EQ(place.status, InverseStatus::unreachable);
  EXPECT_LT(place.position_error, 1e-3);
  EXPECT_NEAR(place.angle_error, 0.6, 1e-2);
  EXPECT_LT(turn.angle_error, 1e-3);
  EXPECT_GT(turn.position_error, 0.05);
}

TEST(Inverse, AWarmMachineArrivesInAFewSteps) {
  Chain chain = laws::dh_with_prismatic();
  chain.expansion = 1e-3;
  const Load warm{.temperature_rise = 50.0};
  const VectorXd truth = (VectorXd(4) << 0.3, 0.4, -0.8, 0.2).finished(), start = truth.array() + 0.02;
  const Vec3 target = forward(chain, truth, warm).position;
  const InverseSolution s = inverse_position(chain, target, start, {}, warm);
  EXPECT_EQ(s.status, InverseStatus::reached);
  EXPECT_LT((forward(chain, s.q, warm).position - target).norm(), 1.01e-9);
  EXPECT_LE(s.iterations, 6);
}

TEST(Inverse, TolerancesAreWhatIsLeftAtMost) {
  const Vec3 target(1.1, 0.7, 0.0);
  const InverseSolution rough = inverse_position(planar(), target, readings(0.4, 0.5), {.position_tolerance = 1e-2}),
                        fine = inverse_position(planar(), target, readings(0.4, 0.5));
  EXPECT_EQ(rough.status, InverseStatus::reached);
  EXPECT_LE(rough.position_error, 1e-2);
  EXPECT_LT(rough.iterations, fine.iterations);
}

TEST(Inverse, AStartOfAnotherLengthStopsTheProgram) {
  EXPECT_DEATH(inverse_position(planar(), Vec3::Zero(), VectorXd::Zero(3)), "3 joint positions for 2 joints");
  EXPECT_DEATH(inverse_position(laws::without_joints(), Vec3::Zero(), VectorXd()), "0 joint positions for 0 joints");
}

}  // namespace
}  // namespace kinfer
