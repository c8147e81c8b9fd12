// SPDX-License-Identifier: Apache-2.0
// Effects beyond rigid geometry (harmonics, backlash, torque, gravity, temperature).
#include "kinfer/kinematics/forward.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "laws/example_chains.hpp"
#include "support/differences.hpp"

namespace kinfer {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

Chain turntable(const Joint& joint = laws::revolute<MdhLink>(0, 0, 0)) {
  Chain chain;
  chain.joints = {joint};
  return chain;
}

/// Angle of a turntable about z.
double turned_angle(const Chain& chain, double q, const Load& load = {}) {
  const Mat3 r = forward(chain, VectorXd::Constant(1, q), load).rotation;
  return std::atan2(r(1, 0), r(0, 0));
}

double pose_distance(const Pose& a, const Pose& b) {
  return std::max((a.position - b.position).norm(), (a.rotation - b.rotation).norm());
}

/// The chain without effects of gravity, which temperature does not scale.
Chain rigid(Chain chain) {
  for (Joint& joint : chain.joints) joint.compliance = 0.0;
  return chain;
}

TEST(Deviation, AHarmonicAddsTheSineAndCosineOfItsOrder) {
  Chain chain = turntable();
  chain.joints[0].harmonics = {{.order = 1.0, .sine = 1e-3, .cosine = -2e-3},
                               {.order = 50.5, .sine = 0.0, .cosine = 3e-3}};
  for (const double q : {-2.0, 0.0, 0.4, 1.7}) {
    const double expected = 1e-3 * std::sin(q) - 2e-3 * std::cos(q) + 3e-3 * std::cos(50.5 * q);
    EXPECT_NEAR(deviations(chain, VectorXd::Constant(1, q))[0], expected, 1e-15);
    EXPECT_NEAR(turned_angle(chain, q), q + expected, 1e-14);
  }
}

TEST(Deviation, AHarmonicFollowsTheJointPositionAndNotTheGearedAngle) {
  Chain chain = turntable();
  chain.joints[0].gain = -2.0;
  chain.joints[0].harmonics = {{.order = 3.0, .sine = 1e-2, .cosine = 0.0}};
  EXPECT_NEAR(turned_angle(chain, 0.3), -0.6 + 1e-2 * std::sin(0.9), 1e-14);
}

TEST(Deviation, ALongSeriesOfHarmonicsIsTheSumOfItsSinesAlsoWhereItIsFoundByRecurrence) {
  Chain chain = turntable();
  Rng rng(3);
  for (int order = 0; order < 95; ++order) {
    const double sine = 1e-3 * rng.normal(), cosine = 1e-3 * rng.normal();
    chain.joints[0].harmonics.push_back({static_cast<double>(order), sine, cosine});
  }
  chain.joints[0].harmonics.push_back({162.5, 1e-3, 2e-3});
  const PoseEvaluator evaluator(chain, {});
  for (const double q : {-5.0, -std::numbers::pi, 0.0, 1e-3, 2.7}) {
    const VectorXd at = VectorXd::Constant(1, q);
    EXPECT_LT((evaluator.pose(at).rotation - forward(chain, at).rotation).norm(), 1e-13) << q;
  }
}

TEST(Deviation, BacklashFollowsTheDirectionOfApproach) {
  Chain chain = turntable();
  chain.joints[0].backlash = 2e-3;
  for (const auto& [approach, expected] : {std::pair{1.0, 0.502}, {-1.0, 0.498}, {0.0, 0.5}, {not_measured, 0.5}}) {
    const std::array from{approach};
    EXPECT_NEAR(turned_angle(chain, 0.5, {.approach = from}), expected, 1e-15);
  }
  EXPECT_NEAR(turned_angle(chain, 0.5), 0.5, 1e-15);
}

TEST(Deviation, AMeasuredTorqueTwistsTheJointAndAMissingOneDoesNot) {
  Chain chain = turntable();
  chain.joints[0].torque_compliance = 1e-4;
  for (const auto& [torque, expected] : {std::pair{30.0, 0.203}, {-30.0, 0.197}, {not_measured, 0.2}}) {
    const std::array measured{torque};
    EXPECT_NEAR(turned_angle(chain, 0.2, {.torques = measured}), expected, 1e-15);
  }
}

TEST(Deviation, OfAJointThatOnlyFollowsOthersIsZero) {
  Chain chain = laws::coupled();
  chain.joints[6].backlash = 1.0, chain.joints[6].harmonics = {{1.0, 1.0, 1.0}};
  const std::array<double, 6> all{1, 1, 1, 1, 1, 1};
  EXPECT_EQ(deviations(chain, VectorXd::Ones(6), {.approach = all})[6], 0.0);
}

TEST(ValueOrZero, IsZeroWhereNothingWasMeasured) {
  const std::array values{1.5, not_measured, -2.0};
  EXPECT_EQ(value_or_zero(values, 0), 1.5);
  EXPECT_EQ(value_or_zero(values, 1), 0.0);
  EXPECT_EQ(value_or_zero(values, 2), -2.0);
  EXPECT_EQ(value_or_zero({}, 7), 0.0);
}

TEST(Displacement, IsGainTimesPositionPlusCouplings) {
  const Chain chain = laws::coupled();
  const VectorXd q = (VectorXd(6) << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6).finished(), moved = joint_displacements(chain, q);
  ASSERT_EQ(moved.size(), 7);
  EXPECT_NEAR(moved[0], chain.joints[0].gain * 0.1, 1e-16);
  EXPECT_NEAR(moved[2], chain.joints[2].gain * 0.3 + 1.0 * 0.2, 1e-16);
  EXPECT_NEAR(moved[5], chain.joints[5].gain * 0.6 + 0.5 * 0.4 - 0.25 * 0.5, 1e-16);
  EXPECT_NEAR(moved[6], -0.7 * 0.1, 1e-16);
}

TEST(Displacement, IsLinearInTheJointPositions) {
  for (const Chain& chain : laws::examples()) {
    const VectorXd p = laws::random_q(chain, Rng(1)), q = laws::random_q(chain, Rng(2));
    const VectorXd sum = joint_displacements(chain, 2.0 * p - 3.0 * q);
    EXPECT_LT((sum - 2.0 * joint_displacements(chain, p) + 3.0 * joint_displacements(chain, q)).norm(), 1e-13);
  }
}

/// All lengths of the robot multiplied by a factor: what a uniform temperature rise does to it.
Chain enlarged(Chain chain, double factor) {
  for (Joint& joint : chain.joints) {
    if (auto* urdf = std::get_if<UrdfLink>(&joint.link)) urdf->origin.xyz *= factor;
    if (auto* dh = std::get_if<DhLink>(&joint.link)) dh->a *= factor, dh->d *= factor;
    if (auto* mdh = std::get_if<MdhLink>(&joint.link)) mdh->a *= factor, mdh->d *= factor;
    if (!translates(joint.type)) continue;
    joint.gain *= factor;
    for (Coupling& coupling : joint.couplings) coupling.factor *= factor;
  }
  return chain;
}

TEST(Temperature, RiseMakesAllLinksLongerAndNotTheTool) {
  constexpr Load warm{.temperature_rise = 40.0};
  for (Chain chain : laws::examples()) {
    chain = rigid(chain);
    chain.expansion = 1e-3;
    const Chain longer = enlarged(chain, 1.04);
    for (std::uint64_t k = 0; k < 5; ++k) {
      const VectorXd q = laws::random_q(chain, Rng(5).stream(k));
      EXPECT_LT(pose_distance(forward(chain, q, warm), forward(longer, q)), 1e-13) << chain.name;
      EXPECT_LT(pose_distance(PoseEvaluator(chain, {}).pose(q, warm), forward(longer, q)), 1e-13) << chain.name;
      const std::vector<Pose> frames = joint_frames(chain, q, warm), expected = joint_frames(longer, q);
      for (std::size_t j = 0; j < frames.size(); ++j) EXPECT_LT(pose_distance(frames[j], expected[j]), 1e-13);
    }
  }
}

TEST(Temperature, JacobianOfAWarmRobotIsTheSlopeOfItsPoses) {
  constexpr Load warm{.temperature_rise = -50.0};
  for (Chain chain : laws::examples_with_joints()) {
    chain = rigid(chain);
    chain.expansion = 2e-3;  // 10 %: nothing hides in the tolerance
    const VectorXd q = laws::random_q(chain, Rng(8));
    const Twists twists = jacobian(chain, q, warm);
    const MatrixXd slope =
        testing::numeric_jacobian([&](const VectorXd& at) { return VectorXd(forward(chain, at, warm).position); }, q);
    EXPECT_LT((twists.topRows<3>() - slope).cwiseAbs().maxCoeff(), 1e-8) << chain.name;
  }
}

TEST(Gravity, GivenTorquesBendJointsLikeOffsets) {
  const Chain chain = laws::compliant();
  const VectorXd q = laws::random_q(chain, Rng(4));
  const std::array<double, 6> torques{100, -200, 50, 30, -20, 10};
  Chain bent = rigid(chain);
  for (std::size_t j = 0; j < 6; ++j)
    std::get<MdhLink>(bent.joints[j].link).theta += chain.joints[j].compliance * torques[j];
  EXPECT_LT(pose_distance(forward(chain, q, {.gravity = torques}), forward(bent, q)), 1e-14);
}

TEST(Gravity, TorquesGrowInProportionToTheMasses) {
  for (Chain chain : {laws::compliant(), laws::compliant_tree()}) {
    const VectorXd q = laws::random_q(chain, Rng(4));
    const VectorXd once = gravity_torques(chain, q, {.payload = 3.0});
    for (PointMass& mass : chain.masses) mass.mass *= 2.0;
    const VectorXd twice = gravity_torques(chain, q, {.payload = 6.0});
    EXPECT_GT(once.norm(), 1.0);
    EXPECT_LT((twice - 2.0 * once).norm(), 1e-12 * twice.norm());
  }
}

TEST(Gravity, OfPlacedJointsIsThatOfTheJointPositions) {
  const Chain chain = rigid(laws::compliant());
  const VectorXd q = laws::random_q(chain, Rng(4));
  const Load load{.payload = 7.0};
  const std::vector<JointPlacement> placed = joint_placements(chain, q, load);
  EXPECT_LT((gravity_torques(chain, placed, load) - gravity_torques(chain, q, load)).norm(), 1e-10);
  VectorXd buffer = VectorXd::Constant(2, 17.0);
  gravity_torques(chain, placed, load, buffer);
  EXPECT_EQ(buffer, gravity_torques(chain, placed, load));
}

TEST(Evaluator, SurvivesBeingMoved) {
  const Chain chain = laws::er20_with_errors();
  const VectorXd q = laws::random_q(chain, Rng(1));
  PoseEvaluator first(chain, {});
  const Pose expected = first.pose(q);
  const PoseEvaluator second = std::move(first);
  EXPECT_EQ(pose_distance(second.pose(q), expected), 0.0);
}

}  // namespace
}  // namespace kinfer
