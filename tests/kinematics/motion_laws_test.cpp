// SPDX-License-Identifier: Apache-2.0
// Laws that tie poses, Jacobians, motions, torques and the inverse together, over all conventions and joint types.
#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/kinematics/dh_conversion.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/frame_motion.hpp"
#include "kinfer/kinematics/inverse.hpp"
#include "laws/example_chains.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

/// The example without compliance, at some joint positions, velocities and accelerations.
struct MovingChain {
  Chain chain;
  VectorXd q, qd, qdd;

  MovingChain(const Chain& example, std::uint64_t seed) : chain(example) {
    for (Joint& joint : chain.joints) joint.compliance = 0.0;
    q = laws::random_q(chain, Rng(seed).stream(1)), qd = laws::random_q(chain, Rng(seed).stream(2));
    qdd = laws::random_q(chain, Rng(seed).stream(3));
  }
  FrameMotion tool() const {
    const std::vector<FrameMotion> motions = joint_motions(chain, q, qd, qdd);
    return attached_frame_motion(motions[static_cast<std::size_t>(chain.tip_joint())], chain.tool.pose());
  }
  /// At the same joint positions, with other derivatives.
  FrameMotion tool_with(const VectorXd& velocity, const VectorXd& acceleration) const {
    MovingChain other = *this;
    other.qd = velocity, other.qdd = acceleration;
    return other.tool();
  }
};

std::vector<MovingChain> moving_chains() {
  std::vector<MovingChain> list;
  for (const Chain& chain : laws::examples_with_joints())
    for (std::uint64_t k = 0; k < 5; ++k) list.emplace_back(chain, 30 + k);
  return list;
}

TEST(MotionLaws, VelocityOfTheToolIsTheJacobianTimesTheJointVelocities) {
  for (const MovingChain& m : moving_chains()) {
    const FrameMotion tool = m.tool();
    const Eigen::Matrix<double, 6, 1> twist = jacobian(m.chain, m.q) * m.qd;
    EXPECT_LT((tool.velocity - twist.head<3>()).norm(), 1e-12 * (1 + twist.norm())) << m.chain.name;
    EXPECT_LT((tool.omega - twist.tail<3>()).norm(), 1e-12 * (1 + twist.norm())) << m.chain.name;
  }
}

TEST(MotionLaws, AccelerationIsTheJacobianTimesThatOfTheJointsPlusATermOfTheVelocities) {
  for (const MovingChain& m : moving_chains()) {
    const Eigen::Matrix<double, 6, 1> driven = jacobian(m.chain, m.q) * m.qdd;
    const FrameMotion all = m.tool(), coasting = m.tool_with(m.qd, 0.0 * m.qdd);
    EXPECT_LT((all.acceleration - coasting.acceleration - driven.head<3>()).norm(), 1e-11 * (1 + driven.norm()));
    EXPECT_LT((all.alpha - coasting.alpha - driven.tail<3>()).norm(), 1e-11 * (1 + driven.norm()));
  }
}

TEST(MotionLaws, TwiceAsFastIsTwiceTheVelocityAndFourTimesTheAcceleration) {
  for (const MovingChain& m : moving_chains()) {
    const VectorXd none = 0.0 * m.qdd;
    const FrameMotion once = m.tool_with(m.qd, none), twice = m.tool_with(2.0 * m.qd, none),
                      back = m.tool_with(-m.qd, none);
    EXPECT_LT((twice.velocity - 2.0 * once.velocity).norm(), 1e-11 * (1 + once.velocity.norm()));
    EXPECT_LT((twice.acceleration - 4.0 * once.acceleration).norm(), 1e-10 * (1 + once.acceleration.norm()));
    EXPECT_LT((back.acceleration - once.acceleration).norm(), 1e-10 * (1 + once.acceleration.norm()));
  }
}

TEST(MotionLaws, AMovedBaseTurnsAllVectors) {
  const Pose shift = Pose::from_xyz_rpy({1, -2, 3}, {0.5, -0.7, 0.9});
  for (MovingChain& m : moving_chains()) {
    const FrameMotion before = m.tool();
    m.chain.base = Frame::from_pose(shift * m.chain.base.pose());
    const FrameMotion after = m.tool();
    for (const auto member :
         {&FrameMotion::omega, &FrameMotion::alpha, &FrameMotion::velocity, &FrameMotion::acceleration})
      EXPECT_LT((after.*member - shift.rotation * before.*member).norm(), 1e-11 * (1 + (before.*member).norm()));
  }
}

TEST(MotionLaws, AFixedFrameTurnsLikeItsParent) {
  Rng rng(2);
  for (const MovingChain& m : moving_chains()) {
    const FrameMotion tool = m.tool();
    const FrameMotion same = attached_frame_motion(tool, {}),
                      other = attached_frame_motion(tool, {exp_so3(test::random_vector(rng)), Vec3::Zero()});
    EXPECT_EQ(same.acceleration, tool.acceleration);
    EXPECT_EQ(other.velocity, tool.velocity);
    EXPECT_EQ(other.omega, tool.omega);
  }
}

TEST(MotionLaws, ASlideOnATurntableFeelsCentripetalAndCoriolisAcceleration) {
  Chain chain;
  chain.joints = {laws::revolute<DhLink>(0, 0, 0),
                  laws::urdf(JointType::prismatic, Vec3::Zero(), Vec3::Zero(), Vec3::UnitX())};
  chain.joints[1].parent = 0;
  const double omega = 3.0, r = 0.5, speed = 0.2, alpha = 1.5, push = 0.7;
  const Eigen::Vector2d q(0.0, r), qd(omega, speed), qdd(alpha, push);
  const FrameMotion slide = joint_motions(chain, q, qd, qdd)[1];
  EXPECT_LT((slide.velocity - Vec3(speed, omega * r, 0)).norm(), 1e-15);
  EXPECT_LT((slide.acceleration - Vec3(push - omega * omega * r, alpha * r + 2 * omega * speed, 0)).norm(), 1e-14);
  EXPECT_LT((slide.omega - Vec3(0, 0, omega)).norm() + (slide.alpha - Vec3(0, 0, alpha)).norm(), 1e-15);
}

TEST(MotionLaws, DerivativesOfAnotherLengthStopTheProgram) {
  EXPECT_DEATH(joint_motions(laws::er20(), VectorXd::Zero(6), VectorXd::Zero(5), VectorXd::Zero(6)), "6, 5, 6");
}

TEST(TorqueLaws, OfAPayloadAreItsWeightThroughTheJacobian) {
  for (const MovingChain& m : moving_chains()) {
    Chain chain = m.chain;
    chain.masses.clear();
    chain.gravity = Vec3(1.0, -2.0, -9.0);
    for (Joint& joint : chain.joints) joint.gain = 1.0, joint.couplings.clear();
    const Load load{.payload = 4.0};
    const VectorXd torques = gravity_torques(chain, m.q, load);
    const VectorXd expected = 4.0 * jacobian(chain, m.q).topRows<3>().transpose() * chain.gravity;
    const std::vector<int> active = active_joints(chain);
    for (std::size_t k = 0; k < active.size(); ++k) {
      const bool is_revolute = rotates(chain.joints[static_cast<std::size_t>(active[k])].type);
      EXPECT_NEAR(torques[active[k]], is_revolute ? expected[static_cast<Eigen::Index>(k)] : 0.0, 1e-11) << chain.name;
    }
  }
}

TEST(TorqueLaws, VanishWithoutGravityAndAlongIt) {
  for (const MovingChain& m : moving_chains()) {
    Chain chain = m.chain;
    chain.gravity.setZero();
    EXPECT_EQ(gravity_torques(chain, m.q, {.payload = 4.0}).norm(), 0.0);
    const JointPlacement first = joint_placements(m.chain, m.q)[0];
    chain.gravity = 9.0 * first.axis;
    EXPECT_NEAR(gravity_torques(chain, m.q, {.payload = 4.0})[0], 0.0, 1e-11) << "about its own direction";
  }
}

TEST(InverseLaws, ASolutionDoesNotDependOnWhereTheBaseStands) {
  const Pose shift = Pose::from_xyz_rpy({1, -2, 3}, {0.5, -0.7, 0.9});
  for (const Chain& chain : {laws::dh_6r(), laws::er20_with_errors(), laws::seven_r()}) {
    const VectorXd truth = laws::random_q(chain, Rng(5)), start = truth.array() + 0.02;
    Chain moved = chain;
    moved.base = Frame::from_pose(shift * chain.base.pose());
    const InverseSolution here = inverse(chain, forward(chain, truth), start),
                          there = inverse(moved, forward(moved, truth), start);
    EXPECT_EQ(here.status, InverseStatus::reached);
    EXPECT_LT((here.q - there.q).norm(), 1e-7) << chain.name;
  }
}

TEST(InverseLaws, OfAConvertedMachineIsThatOfTheOriginal) {
  for (std::uint64_t k = 0; k < 5; ++k) {
    const Chain chain = laws::dh_6r(), other = *as_mdh(chain);
    const VectorXd truth = laws::random_q(chain, Rng(6).stream(k)), start = truth.array() - 0.03;
    const InverseSolution a = inverse(chain, forward(chain, truth), start),
                          b = inverse(other, forward(chain, truth), start);
    EXPECT_LT((a.q - b.q).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace kinfer
