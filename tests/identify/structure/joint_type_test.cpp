// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/joint_type.hpp"

#include "kinfer/geometry/statistics.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "identify/example_machine.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "simulate/worlds.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::swinging_parent;
using test::wave;

SegmentMotion segment_of(const std::string& name, const std::vector<FrameState>& states) {
  SegmentMotion segment{
      .name = name, .rotation = {}, .gyro = {}, .angular_velocity = {}, .angular_acceleration = {}, .acceleration = {}};
  for (const FrameState& s : states) {
    segment.rotation.push_back(s.rotation);
    segment.gyro.push_back(s.rotation.transpose() * s.angular_velocity);
    segment.angular_velocity.push_back(s.angular_velocity);
    segment.angular_acceleration.push_back(s.angular_acceleration);
    segment.acceleration.push_back(s.acceleration);
  }
  return segment;
}

/// A swinging parent and a child behind the leaves, measured without error.
RecordedMotion two_segments(const std::vector<DhLeaf>& leaves, const std::vector<JointSignal>& signals,
                            std::size_t rows = 600) {
  const auto parent = swinging_parent(wave(0.5, 0.7, 0.3, rows));
  RecordedMotion motion;
  motion.period = 0.01;
  for (std::size_t row = 0; row < parent.size(); ++row) motion.time.push_back(0.01 * static_cast<double>(row));
  motion.segments = {segment_of("parent", parent), segment_of("child", propagate(parent, leaves, signals))};
  motion.usable.assign(parent.size(), true);
  return motion;
}

/// A base at rest, an arm that swings on it, and a child behind the leaves, measured without error.
RecordedMotion behind_an_arm(const std::vector<DhLeaf>& leaves, const std::vector<JointSignal>& signals) {
  const auto arm = swinging_parent(wave(0.9, 0.7, 0.3));
  RecordedMotion motion;
  motion.period = 0.01;
  for (std::size_t row = 0; row < arm.size(); ++row) motion.time.push_back(0.01 * static_cast<double>(row));
  motion.segments = {segment_of("base", std::vector<FrameState>(arm.size())), segment_of("arm", arm),
                     segment_of("child", propagate(arm, leaves, signals))};
  motion.usable.assign(arm.size(), true);
  return motion;
}

JointTypeEvidence type_of(const RecordedMotion& motion) {
  const auto tree = segment_tree(motion, "parent");
  EXPECT_TRUE(tree);
  return identify::joint_types(motion, *tree).front();
}

const std::vector<JointSignal>& three_waves() {
  static const std::vector<JointSignal> waves{wave(0.6, 0.9, 1.0), wave(0.4, 1.3, 0.2), wave(0.5, 0.5, 2.0)};
  return waves;
}

TEST(JointType, CountsTheRotationAxesBetweenTwoSegments) {
  const DhLeaf mount{.theta = 0.7, .d = 0.2, .alpha = -1.1, .a = 0.5}, end{.theta = -1.9, .d = 0.15, .alpha = 0.3};
  const DhLeaf first{.alpha = 1.4, .theta_signal = 0}, second{.theta = 1.5, .alpha = -1.3, .theta_signal = 1},
      third{.theta_signal = 2};
  EXPECT_EQ(type_of(two_segments({mount, end}, three_waves())).type, EstimatedJointType::rigid);
  EXPECT_EQ(type_of(two_segments({mount, first, end}, three_waves())).type, EstimatedJointType::revolute);
  const JointTypeEvidence universal = type_of(two_segments({mount, first, second, end}, three_waves()));
  EXPECT_EQ(universal.type, EstimatedJointType::universal);
  EXPECT_EQ(type_of(two_segments({mount, first, second, third, end}, three_waves())).type,
            EstimatedJointType::spherical);
}

/// The child's headings drift by 6° within minutes, as those of gyroscopes do.
RecordedMotion with_heading_drift(RecordedMotion motion) {
  SegmentMotion& child = motion.segments.back();
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    const Mat3 turn = rot_z(0.1 * std::sin(2.0 * std::numbers::pi * motion.time[row] / 300.0));
    child.rotation[row] = turn * child.rotation[row];
    for (Vec3* v : {&child.angular_velocity[row], &child.angular_acceleration[row], &child.acceleration[row]})
      *v = turn * *v;
  }
  return motion;
}

TEST(JointType, OfALongRecordingIsToldBesideDriftingHeadings) {
  constexpr std::size_t rows = 24000;
  const DhLeaf mount{.theta = 0.7, .d = 0.2, .alpha = -1.1, .a = 0.5}, end{.theta = -1.9, .d = 0.15, .alpha = 0.3},
      first{.alpha = 1.4, .theta_signal = 0}, second{.theta = 1.5, .alpha = -1.3, .theta_signal = 1};
  const JointSignal large = wave(0.6, 0.2, 1.0, rows), small = wave(0.15, 0.1, 0.2, rows);
  EXPECT_EQ(type_of(with_heading_drift(two_segments({mount, first, end}, {large}, rows))).type,
            EstimatedJointType::revolute);
  EXPECT_EQ(type_of(with_heading_drift(two_segments({mount, first, second, end}, {large, small}, rows))).type,
            EstimatedJointType::universal);
}

/// The child's heading is another one behind each of three gaps of 2 s.
RecordedMotion with_gaps(RecordedMotion motion) {
  SegmentMotion& child = motion.segments.back();
  const double length = motion.time.back();
  child.restarts = {0.25 * length, 0.5 * length, 0.8 * length};
  constexpr double steps[] = {0.0, 0.3, -0.2, 0.25};  // [rad]
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    const double time = motion.time[row];
    const auto gaps = std::ranges::upper_bound(child.restarts, time) - child.restarts.begin();
    for (const double middle : child.restarts)
      if (std::abs(time - middle) < 1.0) motion.usable[row] = false;
    const Mat3 turn = rot_z(steps[gaps]);
    child.rotation[row] = turn * child.rotation[row];
    for (Vec3* v : {&child.angular_velocity[row], &child.angular_acceleration[row], &child.acceleration[row]})
      *v = turn * *v;
  }
  return motion;
}

TEST(JointType, IsToldBesideHeadingsThatStepBehindGaps) {
  constexpr std::size_t rows = 6000;
  const DhLeaf mount{.theta = 0.7, .d = 0.2, .alpha = -1.1, .a = 0.5}, end{.theta = -1.9, .d = 0.15, .alpha = 0.3},
      first{.alpha = 1.4, .theta_signal = 0}, second{.theta = 1.5, .alpha = -1.3, .theta_signal = 1},
      third{.theta_signal = 2};
  const std::vector<JointSignal> waves{wave(0.6, 0.9, 1.0, rows), wave(0.15, 1.3, 0.2, rows),
                                       wave(0.1, 0.5, 2.0, rows)};
  const auto stated = [&](const std::vector<DhLeaf>& leaves) {
    return type_of(with_gaps(two_segments(leaves, waves, rows))).type;
  };
  EXPECT_EQ(stated({mount, end}), EstimatedJointType::rigid);
  EXPECT_EQ(stated({mount, first, end}), EstimatedJointType::revolute);
  EXPECT_EQ(stated({mount, first, second, end}), EstimatedJointType::universal);
  EXPECT_EQ(stated({mount, first, second, third, end}), EstimatedJointType::spherical);
}

TEST(JointType, ASphericalJointFarFromTheBaseIsNotRevolute) {
  const DhLeaf mount{.theta = 0.7, .d = 0.2, .alpha = -1.1, .a = 0.5}, end{.theta = -1.9, .d = 0.15, .alpha = 0.3};
  const DhLeaf first{.alpha = 1.4, .theta_signal = 0}, second{.theta = 1.5, .alpha = -1.3, .theta_signal = 1},
      third{.theta_signal = 2};
  const std::vector<JointSignal> waves{wave(0.30, 0.5, 1.0), wave(0.25, 0.65, 0.2), wave(0.25, 0.4, 2.0)};
  const RecordedMotion motion = behind_an_arm({mount, first, second, third, end}, waves);
  const auto tree = segment_tree(motion, "base");
  ASSERT_TRUE(tree);
  std::vector<EstimatedJointType> types;
  for (const auto& e : identify::joint_types(motion, *tree)) types.push_back(e.type);
  EXPECT_EQ(types, (std::vector{EstimatedJointType::revolute, EstimatedJointType::spherical}));
}

TEST(JointType, FindsBothAxesOfAUniversalJoint) {
  const DhLeaf mount{.theta = 0.7, .d = 0.2, .alpha = -1.1, .a = 0.5}, end{.theta = -1.9, .d = 0.15, .alpha = 0.3};
  const DhLeaf first{.alpha = 1.4, .theta_signal = 0}, second{.theta_signal = 1};
  const JointTypeEvidence found = type_of(two_segments({mount, first, second, end}, three_waves()));
  const Vec3 in_parent = transform(mount).rotation.col(2), in_child = transform(end).rotation.transpose().col(2);
  EXPECT_LT(found.axis_in_parent.cross(in_parent).norm(), 1e-3);
  EXPECT_LT(found.axis_in_child.cross(in_child).norm(), 1e-3);
}

TEST(JointType, FindsTheCranesPrismaticAndRevoluteJoints) {
  for (const char* grade : {"noise", "industrial"}) {
    const MujocoWorld world = test::world_of("crane", {}, 4);
    const MachineMotion motion = world.prescribe(test::drive_of(world.machine(), {}, 4), 100.0);
    const auto ordered =
        order_segments(simulate_recording(world.machine(), motion, *sensor_grade(grade), {}, Rng(4)), {}, {}, 0);
    ASSERT_TRUE(ordered);
    std::vector<EstimatedJointType> types;
    for (const auto& e : identify::joint_types(ordered->motion, ordered->tree)) types.push_back(e.type);
    using enum EstimatedJointType;
    EXPECT_EQ(types, (std::vector{revolute, revolute, prismatic, revolute})) << grade;
  }
}

TEST(JointType, DistinguishesSphericalFromRevoluteJointsOfAMeasuredChain) {
  const char* root = std::getenv("KINFER_DATA");
  if (!root) GTEST_SKIP() << "KINFER_DATA is not set";
  for (const char* mounts : {"rigid.csv", "nonrigid.csv"}) {
    const auto recording = read_ins_csv(std::filesystem::path(root) / "diodem_chain5" / "trial1" / mounts);
    ASSERT_TRUE(recording);
    const auto ordered = order_segments(*recording, {}, "seg1", 0);
    ASSERT_TRUE(ordered);
    std::vector<EstimatedJointType> types;
    for (const auto& e : identify::joint_types(ordered->motion, ordered->tree)) types.push_back(e.type);
    using enum EstimatedJointType;
    EXPECT_EQ(types, (std::vector{spherical, revolute, revolute, revolute})) << mounts;
  }
}

TEST(EffectiveSamples, OfASlowWaveAreFewAndOfNoiseAll) {
  Rng rng(1);
  std::vector<double> noise, slow;
  for (int i = 0; i < 4000; ++i) {
    noise.push_back(rng.normal());
    slow.push_back((slow.empty() ? 0.0 : 0.9 * slow.back()) + rng.normal());
  }
  EXPECT_GT(effective_samples(noise), 3500.0);
  EXPECT_NEAR(effective_samples(slow), 4000.0 * 0.1 / 1.9, 60.0);  // closed form of a first-order process
}

}  // namespace
}  // namespace kinfer
