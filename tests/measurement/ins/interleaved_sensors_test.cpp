// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/interleaved_sensors.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace kinfer {
namespace {

constexpr auto missing = static_cast<std::uint8_t>(acceleration_missing | angular_velocity_missing | field_missing);

/// `turns` sensors in one file, each with a sample in every `turns`-th row, whose number is its angular velocity.
InsRecording in_turns(std::size_t turns, std::size_t rows) {
  InsRecording recording;
  recording.loggers = {{"log", {}}};
  for (std::size_t row = 0; row < rows; ++row) recording.loggers[0].time.push_back(0.01 * static_cast<double>(row));
  for (std::size_t s = 0; s < turns; ++s) {
    InsSensor& sensor = recording.sensors.emplace_back();
    sensor.name = "ins" + std::to_string(s);
    for (std::size_t row = 0; row < rows; ++row) {
      const bool has = row % turns == s;
      for (auto* triad : {&sensor.acceleration, &sensor.angular_velocity})
        for (auto& axis : triad->axis)
          axis.push_back(has ? static_cast<float>(row) : std::numeric_limits<float>::quiet_NaN());
      sensor.faults.push_back(
          static_cast<std::uint8_t>(has ? static_cast<unsigned>(field_missing) : static_cast<unsigned>(missing)));
    }
  }
  return recording;
}

TEST(InterleavedSensors, GetTheirOwnRowsOnTheSameClock) {
  const InsRecording recording = in_turns(3, 300);
  const auto separate = separate_interleaved_sensors(recording);
  ASSERT_TRUE(separate);
  ASSERT_EQ(separate->loggers.size(), 3u);
  for (std::size_t s = 0; s < 3; ++s) {
    const InsSensor& sensor = separate->sensors[s];
    ASSERT_EQ(sensor.rows(), 100u);
    EXPECT_NEAR(median_period(separate->time(sensor)), 0.03, 1e-12);
    EXPECT_FLOAT_EQ(sensor.angular_velocity.axis[1][10], static_cast<float>(30 + s));
    EXPECT_NEAR(separate->time(sensor)[10], 0.01 * static_cast<double>(30 + s), 1e-12);
    EXPECT_TRUE(share_clock(*separate, 0, sensor.logger));
  }
}

TEST(InterleavedSensors, AreNotThoseThatLoseSamples) {
  InsRecording recording = in_turns(1, 300);
  for (std::size_t row = 0; row < 300; ++row)
    if (row % 4 == 0) recording.sensors[0].faults[row] = missing;
  EXPECT_FALSE(separate_interleaved_sensors(recording));
  for (std::size_t row = 100; row < 300; ++row) recording.sensors[0].faults[row] = missing;  // died
  EXPECT_FALSE(separate_interleaved_sensors(recording));
}

TEST(InterleavedSensors, SampledAtTheSameInstantsStayTogether) {
  InsRecording recording = in_turns(2, 300);
  recording.sensors.push_back(recording.sensors[0]);
  recording.sensors.back().name = "twin";
  const auto separate = separate_interleaved_sensors(recording);
  ASSERT_TRUE(separate);
  EXPECT_EQ(separate->loggers.size(), 2u);
  EXPECT_EQ(separate->sensors[0].logger, separate->sensors[2].logger);
}

TEST(SharedClock, LoggersHaveClocksOfTheirOwnUnlessTheySaySo) {
  InsRecording recording;
  recording.loggers = {{"a", {0.0}}, {"b", {0.0}}, {"c", {0.0}, 4}, {"d", {0.0}, 4}};
  EXPECT_FALSE(share_clock(recording, 0, 1));
  EXPECT_TRUE(share_clock(recording, 1, 1));
  EXPECT_FALSE(share_clock(recording, 1, 2));
  EXPECT_TRUE(share_clock(recording, 2, 3));
}

}  // namespace
}  // namespace kinfer
