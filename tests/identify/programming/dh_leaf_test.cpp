// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/dh_leaf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "identify/measured_segments.hpp"
#include "kinfer/identify/programming/bacterial_search.hpp"

namespace kinfer {
using namespace identify;
namespace {

const std::vector<double> two_signals{0.3, -0.8};

TEST(DhLeaf, IsTheProductOfFourElementaryMotions) {
  const DhLeaf leaf{.theta = 0.4, .d = 0.7, .alpha = -1.1, .a = 0.2, .theta_signal = 1, .alpha_signal = 0};
  EXPECT_DOUBLE_EQ(theta_of(leaf, two_signals), 0.4 - 0.8);
  EXPECT_DOUBLE_EQ(alpha_of(leaf, two_signals), -1.1 + 0.3);
  const Pose slow = Pose{Mat3::Identity(), {0.0, 0.0, 0.7}} * Pose{rot_z(-0.4), Vec3::Zero()} *
                    Pose{Mat3::Identity(), {0.2, 0.0, 0.0}} * Pose{rot_x(-0.8), Vec3::Zero()};
  const Pose fast = transform(leaf, two_signals);
  EXPECT_LT((fast.rotation - slow.rotation).norm(), 1e-14);
  EXPECT_LT((fast.position - slow.position).norm(), 1e-14);
  EXPECT_LT((transform(std::vector<DhLeaf>{}).position).norm(), 1e-300) << "no leaves: nothing moves";
}

TEST(DhLeaf, SignalsAreCountedInBothAngles) {
  EXPECT_EQ(count_signal_uses({}), 0);
  const std::vector<DhLeaf> leaves{{.theta_signal = 0}, {}, {.theta_signal = 1, .alpha_signal = 0}};
  EXPECT_EQ(count_signal_uses(leaves), 3);
}

TEST(DhLeafOperators, APlainSignalHasNoConstantHoweverOftenItMutates) {
  const DhLeafOperators plain({.signals = 3});
  Rng rng(1);
  int variable = 0;
  std::vector<DhLeaf> leaves(4);
  for (DhLeaf& leaf : leaves) leaf = plain.random(rng);
  for (int k = 0; k < 2000; ++k) {
    plain.vary(leaves, rng);
    for (const DhLeaf& leaf : leaves) {
      const bool is_variable = leaf.theta_signal != DhLeaf::constant;
      variable += is_variable ? 1 : 0;
      EXPECT_TRUE(!is_variable || leaf.theta == 0.0);
      EXPECT_TRUE(leaf.alpha_signal == DhLeaf::constant || leaf.alpha == 0.0);
      EXPECT_LT(std::max(leaf.theta_signal, leaf.alpha_signal), 3);
    }
  }
  EXPECT_GT(variable, 500);
}

TEST(DhLeafOperators, DrawsWithTheStatedProbabilities) {
  const DhLeafOptions options{.signals = 1, .signal_angle_form = SignalAngleForm::offset};
  const DhLeafOperators operators(options);
  Rng rng(2);
  constexpr int draws = 20000;
  int signals = 0, alpha_signals = 0, zero_lengths = 0, right_angles = 0, other_angles = 0;
  double longest = 0.0;
  for (int k = 0; k < draws; ++k) {
    const DhLeaf leaf = operators.random(rng);
    signals += leaf.theta_signal == 0 ? 1 : 0;
    alpha_signals += leaf.alpha_signal == 0 ? 1 : 0;
    zero_lengths += leaf.d == 0.0 ? 1 : 0;
    longest = std::max({longest, std::abs(leaf.d), std::abs(leaf.a)});
    if (leaf.theta != 0.0)
      (std::abs(std::remainder(leaf.theta, 0.5 * std::numbers::pi)) < 1e-12 ? right_angles : other_angles) += 1;
  }
  const auto share = [](int count, int of) { return static_cast<double>(count) / of; };
  EXPECT_NEAR(share(signals, draws), options.signal_probability, 0.02);
  EXPECT_NEAR(share(alpha_signals, draws), options.signal_probability / 3.0, 0.02);
  EXPECT_NEAR(share(zero_lengths, draws), options.zero_probability, 0.02);
  // Of the right angles -90°, 0°, 90° and 180° three are not zero.
  const double right = 0.75 * options.right_angle_probability, other = 1.0 - options.right_angle_probability;
  EXPECT_NEAR(share(right_angles, right_angles + other_angles), right / (right + other), 0.02);
  EXPECT_LE(longest, options.max_length);
  EXPECT_GT(longest, 0.95 * options.max_length);
}

TEST(DhLeafOperators, WithoutSignalsEveryAngleIsAConstant) {
  const DhLeafOperators operators({.signals = 0});
  Rng rng(3);
  for (int k = 0; k < 200; ++k) {
    const DhLeaf leaf = operators.random(rng);
    EXPECT_EQ(leaf.theta_signal, DhLeaf::constant);
    EXPECT_EQ(leaf.alpha_signal, DhLeaf::constant);
  }
}

TEST(DhLeafOperators, TheSameSeedMutatesAlike) {
  const DhLeafOperators operators({.signals = 2, .signal_angle_form = SignalAngleForm::offset});
  const auto mutated = [&](std::uint64_t seed) {
    std::vector<DhLeaf> leaves = test::general_hinge();
    Rng rng(seed);
    for (int k = 0; k < 20; ++k) operators.vary(leaves, rng);
    return std::array{leaves[0].theta, leaves[1].d, leaves[2].a, leaves[1].alpha};
  };
  EXPECT_EQ(mutated(7), mutated(7));
  EXPECT_NE(mutated(7), mutated(8));
}

RecordedMotion turning_child() {
  return test::recorded_motion(
      {test::measured_segment("parent", test::at_rest()),
       test::measured_segment("child", propagate(test::at_rest(), test::general_hinge(), test::three_signals()))});
}

TEST(InformativeRows, AreUsableInMotionAndNotBeforeTheFirstMotion) {
  RecordedMotion motion = turning_child();
  motion.first_motion_row = 100;
  motion.usable[200] = false;
  for (std::size_t row = 300; row < 320; ++row) motion.segments[1].angular_velocity[row].setZero();
  const auto rows = informative_rows(motion, 0, 1, JointVariableKind::hinge);
  EXPECT_EQ(rows.front(), 100U);
  EXPECT_TRUE(std::ranges::is_sorted(rows));
  for (const std::size_t row : rows) {
    EXPECT_NE(row, 200U);
    EXPECT_TRUE(row < 300 || row >= 320) << row;
    EXPECT_GE(motion.segments[1].angular_velocity[row].norm(), 0.02);
  }
  EXPECT_GT(rows.size(), 450U);
  EXPECT_LE(rows.size(), 500U - 21U);
}

TEST(InformativeRows, EulerAnglesExcludeTheirGimbalLockInEitherSensor) {
  RecordedMotion motion = turning_child();
  for (SegmentMotion& segment : motion.segments) std::ranges::fill(segment.rotation, Mat3::Identity());
  const auto everything = informative_rows(motion, 0, 1, JointVariableKind::euler);
  EXPECT_EQ(everything, informative_rows(motion, 0, 1, JointVariableKind::hinge));
  for (const std::size_t segment : {0U, 1U}) {
    RecordedMotion upright = motion;
    for (std::size_t row = 0; row < 300; ++row) upright.segments[segment].rotation[row] = rot_y(1.5);  // 4° short of it
    const auto rows = informative_rows(upright, 0, 1, JointVariableKind::euler);
    ASSERT_FALSE(rows.empty());
    EXPECT_GE(rows.front(), 300U);
    for (std::size_t row = 0; row < 300; ++row) upright.segments[segment].rotation[row] = rot_y(1.4);  // 10°
    EXPECT_EQ(informative_rows(upright, 0, 1, JointVariableKind::euler), everything);
  }
}

}  // namespace
}  // namespace kinfer
