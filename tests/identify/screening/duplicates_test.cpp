// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/duplicates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "identify/driven_machine.hpp"
#include "kinfer/words/identification/verdict.hpp"

namespace kinfer {
using namespace identify;
namespace {

InsSensor waving_sensor(const std::string& name, float phase) {
  InsSensor sensor;
  sensor.name = name;
  for (std::size_t row = 0; row < 400; ++row)
    for (std::size_t k = 0; k < 3; ++k) {
      const float angle = 0.05f * static_cast<float>(row) + static_cast<float>(k) + phase;
      sensor.acceleration.axis[k].push_back(std::sin(angle));
      sensor.angular_velocity.axis[k].push_back(std::cos(angle));
    }
  sensor.faults.assign(400, 0);
  return sensor;
}

InsRecording three_sensors() {
  InsRecording recording;
  recording.loggers.push_back({"log", {}});
  for (std::size_t row = 0; row < 400; ++row) recording.loggers[0].time.push_back(0.01 * static_cast<double>(row));
  recording.sensors = {waving_sensor("a", 0.0f), waving_sensor("b", 0.1f), waving_sensor("c", 0.2f)};
  return recording;
}

TEST(Duplicates, ASensorUnderTwoNamesIsFound) {
  InsRecording recording = three_sensors();
  EXPECT_TRUE(duplicate_findings(recording, {0, 1, 2}).empty());
  recording.sensors[2] = recording.sensors[0];
  recording.sensors[2].name = "copy";
  recording.sensors[2].acceleration.axis[0][7] = std::nanf("");  // a sample that was lost in one file
  const auto found = duplicate_findings(recording, {0, 1, 2});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].values.text("first"), "a");
  EXPECT_EQ(found[0].values.text("second"), "copy");
  EXPECT_TRUE(invalidates_result(found[0]));
  EXPECT_TRUE(duplicate_findings(recording, {1, 2}).empty()) << "the user left the other one out";
}

TEST(Duplicates, ChannelsThatNeverChangeProveNothing) {
  InsRecording recording = three_sensors();
  for (InsSensor& sensor : recording.sensors)
    for (auto* columns : {&sensor.acceleration, &sensor.angular_velocity})
      for (auto& axis : columns->axis) axis.assign(400, 0.0f);
  EXPECT_TRUE(duplicate_findings(recording, {0, 1, 2}).empty());
}

TEST(Duplicates, ForbidUse) {
  test::DrivenMachine drive = test::driven_arm(5, 4);
  InsSensor copy = drive.recording.sensors[3];
  copy.name = "copy";
  drive.recording.sensors.push_back(copy);
  const Identification found = test::identified(drive.recording);
  EXPECT_EQ(found.usability, Usability::do_not_use);
  EXPECT_TRUE(test::has_finding(found, "duplicate_sensor", "ins3 and copy"));
  EXPECT_EQ(found.verdicts.size(), drive.truth.joints.size() + 1);
  EXPECT_EQ(found.verdicts.front().usability, JointUsability::use);
  EXPECT_NE(words::identification_verdict(found).find("ins0-ins1, ins1-ins2"), std::string::npos)
      << "the good part is named";
  drive.recording.sensors = {drive.recording.sensors[3], copy};
  const auto alone = identify_machine(drive.recording, {}, Rng(1));
  ASSERT_FALSE(alone);
  EXPECT_NE(alone.error().what.find("hold the same measurements"), std::string::npos) << alone.error().what;
}

}  // namespace
}  // namespace kinfer
