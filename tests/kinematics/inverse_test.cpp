// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/inverse.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <set>

#include "laws/example_chains.hpp"

namespace kinfer {

/// How GoogleTest prints a status.
void PrintTo(InverseStatus status, std::ostream* out) {
  *out << sentence(status);
}

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

TEST(Inverse, EveryStatusHasASentenceOfItsOwn) {
  std::set<std::string_view> sentences;
  for (int i = 0; i <= static_cast<int>(InverseStatus::iteration_limit); ++i)
    sentences.insert(sentence(static_cast<InverseStatus>(i)));
  EXPECT_EQ(sentences.size(), 5u);
  EXPECT_FALSE(sentences.contains(""));
}

}  // namespace
}  // namespace kinfer
