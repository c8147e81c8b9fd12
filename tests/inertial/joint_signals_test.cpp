// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/joint_signals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/rng.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

using std::numbers::pi;

constexpr double signal_period = 0.005;  // [s]

/// Orientation of the parent at a time: it turns about all axes.
Mat3 parent_rotation(double t) {
  return from_rpy({0.4 * std::sin(1.1 * t), 0.5 * std::sin(0.7 * t + 1.0), 0.6 * t});
}

/// A segment that has this orientation at every time, with the gyro of its motion.
template <class Rotation>
SegmentMotion segment_of(const std::string& name, const Rotation& rotation, std::size_t rows) {
  constexpr double h = 1e-5;
  SegmentMotion segment;
  segment.name = name;
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = signal_period * static_cast<double>(i);
    segment.rotation.push_back(rotation(t));
    segment.gyro.push_back(log_so3(rotation(t - h).transpose() * rotation(t + h)) / (2 * h));
  }
  return segment;
}

/// Parent and child whose relative rotation is `relative`(t).
template <class Relative>
RecordedMotion two_segments(const Relative& relative, std::size_t rows = 2000) {
  RecordedMotion motion;
  motion.period = signal_period;
  for (std::size_t i = 0; i < rows; ++i) motion.time.push_back(signal_period * static_cast<double>(i));
  motion.segments = {segment_of("a", parent_rotation, rows),
                     segment_of(
                         "b", [&](double t) { return Mat3(parent_rotation(t) * relative(t)); }, rows)};
  return motion;
}

TEST(JointSignals, AHingeHasItsAngleAndTheDerivativesOfIt) {
  Rng rng(1);
  for (int k = 0; k < 5; ++k) {
    Vec3 axis = test::random_vector(rng).normalized();
    Eigen::Index largest = 0;
    axis.cwiseAbs().maxCoeff(&largest);
    if (axis[largest] < 0.0) axis = -axis;  // the sense that is reported
    const Mat3 mounting = exp_so3(test::random_vector(rng));
    const auto q = [](double t) { return 0.8 * std::sin(1.3 * t); };
    const auto signals =
        find_joint_signals(two_segments([&](double t) { return Mat3(exp_so3(q(t) * axis) * mounting); }), 0, 1);
    ASSERT_EQ(signals.size(), 1u);
    EXPECT_EQ(signals[0].name, "q");
    for (const std::size_t row : {300u, 900u, 1700u}) {
      const double t = signal_period * static_cast<double>(row);
      EXPECT_NEAR(signals[0].angle[row], q(t), 2e-3);  // the smoothing takes 0.03 %
      EXPECT_NEAR(signals[0].angular_velocity[row], 0.8 * 1.3 * std::cos(1.3 * t), 2e-3);
      EXPECT_NEAR(signals[0].angular_acceleration[row], -0.8 * 1.69 * std::sin(1.3 * t), 3e-3);
    }
  }
}

TEST(JointSignals, AHingeThatTurnsOverAndOverHasNoJumps) {
  const auto signals = find_joint_signals(two_segments([](double t) { return rot_z(1.5 * t); }), 0, 1);
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_NEAR(signals[0].angle[1900], 1.5 * 9.5, 5e-3);
  for (std::size_t i = 50; i + 50 < signals[0].angle.size(); ++i)
    ASSERT_NEAR(signals[0].angle[i + 1] - signals[0].angle[i], 1.5 * signal_period, 1e-5);
}

TEST(JointSignals, SegmentsThatDoNotTurnAgainstEachOtherHaveNone) {
  const RecordedMotion motion = two_segments([](double) { return rot_x(1.0); });
  EXPECT_TRUE(find_joint_signals(motion, 0, 1).empty());
  EXPECT_TRUE(find_joint_signals(motion, 0, 1, {.terminals = JointVariableKind::euler, .min_rotation = 10.0}).empty());
}

TEST(JointSignals, AreTheSameSignalWithTheOtherSignSeenFromTheChild) {
  const RecordedMotion motion = two_segments([](double t) { return rot_z(0.5 * std::sin(t)); });
  const auto there = find_joint_signals(motion, 0, 1), back = find_joint_signals(motion, 1, 0);
  ASSERT_TRUE(there.size() == 1 && back.size() == 1);
  for (const std::size_t row : {200u, 1000u, 1900u}) EXPECT_NEAR(there[0].angle[row], -back[0].angle[row], 1e-9);
}

TEST(JointSignals, EulerDifferencesAreThePapersAndWeakOnesAreDropped) {
  RecordedMotion motion = two_segments([](double) { return Mat3(Mat3::Identity()); });
  const auto roll = [](double t) { return 0.5 * std::sin(t); };
  const auto yaw = [](double t) { return 0.9 * t; };
  motion.segments = {segment_of(
                         "a", [](double) { return rot_z(0.2); }, motion.rows()),
                     segment_of(
                         "b",
                         [&](double t) {
                           return from_rpy({roll(t), 0.001 * std::sin(t), 0.2 + yaw(t)});
                         },
                         motion.rows())};
  const auto signals = find_joint_signals(motion, 0, 1, {.terminals = JointVariableKind::euler});
  ASSERT_EQ(signals.size(), 2u);
  EXPECT_EQ(signals[0].name, "phi");
  EXPECT_EQ(signals[1].name, "psi");
  for (const std::size_t row : {400u, 1500u}) {
    const double t = signal_period * static_cast<double>(row);
    EXPECT_NEAR(signals[0].angle[row], roll(t), 2e-3);
    EXPECT_NEAR(signals[0].angular_velocity[row], 0.5 * std::cos(t), 3e-3);
    EXPECT_NEAR(signals[1].angle[row], yaw(t), 2e-3);
    EXPECT_NEAR(signals[1].angular_velocity[row], 0.9, 3e-3);
  }
}

TEST(EulerAngles, AreRollPitchAndYawOfTheRotation) {
  for (const double roll : {-2.0, 0.0, 1.3})
    for (const double pitch : {-1.4, 0.0, 0.6})
      for (const double yaw : {-3.0, 0.2}) {
        const Mat3 r = from_rpy({roll, pitch, yaw});
        EXPECT_LT((euler_angles(r) - Vec3(roll, pitch, yaw)).norm(), 1e-12);
        const Vec3 other = alternative_euler_angles({roll, pitch, yaw});
        EXPECT_LT((from_rpy(other) - r).norm(), 1e-14) << "the same rotation by other angles";
        EXPECT_GE(std::abs(other.y()), pi / 2);
        EXPECT_LT((alternative_euler_angles(other) - Vec3(roll, pitch, yaw)).norm(), 1e-12);
      }
  EXPECT_NEAR(euler_angles(rot_y(pi / 2)).y(), pi / 2, 1e-7);
}

TEST(WrapToPi, LeavesLessThanHalfATurn) {
  for (const auto& [angle, wrapped] : {std::pair{0.3, 0.3},
                                       {2 * pi + 0.3, 0.3},
                                       {-2 * pi + 0.3, 0.3},
                                       {1.5 * pi, -0.5 * pi},
                                       {-1.5 * pi, 0.5 * pi},
                                       {20 * pi - 1.0, -1.0}})
    EXPECT_NEAR(wrap_to_pi(angle), wrapped, 1e-14);
  EXPECT_NEAR(std::abs(wrap_to_pi(pi)), pi, 1e-15);
}

}  // namespace
}  // namespace kinfer
