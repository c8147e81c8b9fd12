// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/ins_selection.hpp"

#include <gtest/gtest.h>

namespace kinfer {
namespace {

InsRecording three_sensors() {
  InsRecording recording;
  recording.loggers = {{"a", {0.0, 1.0, 2.0}}, {"b", {0.5, 1.5}}};
  for (const char* name : {"x", "y", "z"}) {
    InsSensor sensor{.name = name, .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {0, 0, 0}};
    for (auto& axis : sensor.angular_velocity.axis) axis = {1.0f, 2.0f, 3.0f};
    recording.sensors.push_back(sensor);
  }
  InsSensor& last = recording.sensors.back();
  last.logger = 1;
  last.faults.resize(2);
  for (auto& axis : last.angular_velocity.axis) axis.resize(2);
  return recording;
}

TEST(InsSelection, KeepsOnlyTheLoggersOfTheSelectedSensors) {
  const InsRecording found = select_sensors(three_sensors(), {2, 0});
  ASSERT_EQ(found.sensors.size(), 2u);
  EXPECT_EQ(found.sensors[0].name, "z");
  EXPECT_EQ(found.loggers[found.sensors[0].logger].name, "b");
  EXPECT_EQ(found.loggers[found.sensors[1].logger].name, "a");
  EXPECT_EQ(select_sensors(three_sensors(), {1}).loggers.size(), 1u);
}

TEST(InsSelection, FindsSensorsByNameOrReportsThemMissing) {
  EXPECT_EQ(*find_sensors(three_sensors(), {"z", "x"}), (std::vector<std::size_t>{2, 0}));
  EXPECT_EQ(find_sensors(three_sensors(), {"w"}).error().what, "no sensor w; the log has x, y, z");
}

TEST(Within, KeepsTheRowsOfTheTimeOfEveryLogger) {
  const InsRecording found = within(three_sensors(), 0.6, 1.6);
  EXPECT_EQ(found.loggers[0].time, std::vector<double>{1.0});
  EXPECT_EQ(found.loggers[1].time, std::vector<double>{1.5});
  EXPECT_EQ(found.sensors[0].angular_velocity.axis[2], std::vector<float>{2.0f});
  EXPECT_EQ(found.sensors[2].angular_velocity.axis[0], std::vector<float>{2.0f});
  EXPECT_TRUE(found.sensors[1].acceleration.axis[0].empty());
  EXPECT_EQ(found.sensors[0].rows(), 1u);
}

}  // namespace
}  // namespace kinfer
