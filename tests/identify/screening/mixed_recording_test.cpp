// SPDX-License-Identifier: Apache-2.0
// Sensors that are exchanged, or logs that are put together, are told from sensors that are only fastened otherwise.
#include "kinfer/identify/screening/mixed_recording.hpp"

#include <gtest/gtest.h>

#include "identify/driven_machine.hpp"
#include "kinfer/simulate/log_faults.hpp"
#include "repeats.hpp"

namespace kinfer {
using namespace identify;
namespace {

/// From `row` on, the samples of `other`.
void replace_from(InsSensor& sensor, const InsSensor& other, std::size_t row) {
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = row; i < std::min(sensor.rows(), other.rows()); ++i) {
      sensor.acceleration.axis[k][i] = other.acceleration.axis[k][i];
      sensor.angular_velocity.axis[k][i] = other.angular_velocity.axis[k][i];
    }
}

InsRecording excavator(std::uint64_t seed) {
  return test::driven_machine("excavator-general", seed).recording;
}

/// From the middle on each sensor is where the other one was.
InsRecording with_exchanged(InsRecording recording, std::size_t a, std::size_t b) {
  const std::size_t middle = recording.sensors[a].rows() / 2;
  const InsSensor first = recording.sensors[a];
  replace_from(recording.sensors[a], recording.sensors[b], middle);
  replace_from(recording.sensors[b], first, middle);
  return recording;
}

/// Sensor 2 is fastened otherwise from the middle on.
InsRecording with_refastened(std::uint64_t seed) {
  const MujocoWorld world = test::world_of("excavator-general", {.mounting = Mounting::arbitrary}, seed);
  const MachineMotion motion =
      world.prescribe(test::drive_of(world.machine(), {.script = Script::standard}, seed), 100.0);
  const MachineMotion changed = with_remount(motion, 2, static_cast<std::size_t>(motion.time.size() / 2),
                                             {exp_so3(Vec3(0.2, 0.3, 0.1)), Vec3(0.06, 0.0, 0.08)});
  return simulate_recording(world.machine(), changed, *sensor_grade("industrial"), {}, Rng(seed));
}

double middle(const InsRecording& recording) {
  return 0.5 * (recording.loggers.front().time.front() + recording.loggers.front().time.back());
}

bool is_mixed(const InsRecording& recording) {
  return find_mixed_part(recording, middle(recording), {}, 2).has_value();
}

std::vector<FindingKind> kinds_of(const InsRecording& recording) {
  const auto found = identify_machine(recording, {.threads = 2}, Rng(1));
  EXPECT_TRUE(found) << found.error().what;
  std::vector<FindingKind> kinds;
  if (found)
    for (const Finding& finding : found->findings) kinds.push_back(finding.kind);
  return kinds;
}

TEST(MixedRecording, ExchangedSensorsShareOtherJoints) {
  const InsRecording recording = with_exchanged(excavator(3), 2, 3);
  const auto part = find_mixed_part(recording, middle(recording), {}, 2);
  ASSERT_TRUE(part);
  EXPECT_NEAR(part->end - part->begin, middle(recording) - recording.loggers.front().time.front(), 0.1);
}

TEST(MixedRecording, LogsOfTwoDrivesThatWerePutTogetherAreNamed) {
  InsRecording recording = excavator(4);
  replace_from(recording.sensors[3], excavator(9).sensors[3], recording.sensors[3].rows() / 2);
  EXPECT_TRUE(is_mixed(recording));
}

TEST(MixedRecording, SoundAndRefastenedSensorsAreNot) {
  for (const std::uint64_t seed : test::repeats({5, 6})) {
    EXPECT_FALSE(is_mixed(excavator(seed)));
    EXPECT_FALSE(is_mixed(with_refastened(seed)));
  }
}

TEST(MixedRecording, IdentificationNamesItInsteadOfARemounting) {
  const auto exchanged = kinds_of(with_exchanged(excavator(7), 3, 4)), refastened = kinds_of(with_refastened(7));
  EXPECT_EQ(std::ranges::count(exchanged, FindingKind::remounted), 0);
  EXPECT_GE(std::ranges::count(exchanged, FindingKind::mixed_recording), 1);
  EXPECT_EQ(std::ranges::count(refastened, FindingKind::remounted), 1);
  EXPECT_EQ(std::ranges::count(refastened, FindingKind::mixed_recording), 0);
}

/// Sensor 2 of a six-axis arm is fastened otherwise from 20 s on.
TEST(MixedRecording, NoJointOfTheSensorIsUsable) {
  const MujocoWorld world = test::world_of("robot6", {}, 51);
  const MachineMotion motion = with_remount(world.prescribe(test::drive_of(world.machine(), {}, 51), 100.0), 2, 2000,
                                            {exp_so3(Vec3(0.2, 0.3, 0.1)), Vec3(0.06, 0.0, 0.08)});
  const auto found = identify_machine(
      simulate_recording(world.machine(), motion, *sensor_grade("industrial"), {}, Rng(51)), {}, Rng(1));
  ASSERT_TRUE(found);
  ASSERT_TRUE(std::ranges::count(found->findings, FindingKind::mixed_recording, &Finding::kind));
  for (std::size_t j = 0; j < found->joints.size(); ++j) {
    const JointEstimate& joint = found->joints[j];
    const bool is_of_sensor = joint.parent == "ins2" || joint.child == "ins2";
    EXPECT_EQ(found->verdicts[j].usability == JointUsability::do_not_use, is_of_sensor) << joint_name(joint);
  }
}

TEST(MixedRecording, ShortOrUnorderablePartsAreNotJudged) {
  const InsRecording recording = excavator(5);
  EXPECT_FALSE(find_mixed_part(recording, recording.loggers.front().time.front() + 2.0, {}, 2));
}

}  // namespace
}  // namespace kinfer
