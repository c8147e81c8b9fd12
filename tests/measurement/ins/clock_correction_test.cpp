// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/clock_correction.hpp"

#include <gtest/gtest.h>

namespace kinfer {
namespace {

InsRecording three_clocks() {
  InsRecording recording;
  recording.loggers = {{"a", {0.0, 1.0, 2.0}}, {"b", {5.0, 6.0}}};
  recording.sensors.resize(3);
  recording.sensors[2].logger = 1;
  return recording;
}

TEST(ClockCorrection, EveryTimeIsShiftedByOffsetAndDrift) {
  const std::vector<ClockCorrection> corrections{{}, {.offset = 0.5, .drift = 0.1, .middle = 1.0}, {.offset = -5.0}};
  const InsRecording found = synchronise_sensors(three_clocks(), corrections);
  EXPECT_DOUBLE_EQ(found.time(found.sensors[0])[2], 2.0);
  EXPECT_DOUBLE_EQ(found.time(found.sensors[1])[0], 0.4);
  EXPECT_DOUBLE_EQ(found.time(found.sensors[1])[2], 2.6);
  EXPECT_DOUBLE_EQ(found.time(found.sensors[2])[0], 0.0);
}

TEST(ClockCorrection, SensorsOfOneLoggerWithEqualCorrectionsStayTogether) {
  const std::vector<ClockCorrection> same{{.offset = 0.1}, {.offset = 0.1, .middle = 7.0}, {.offset = 0.1}};
  const InsRecording found = synchronise_sensors(three_clocks(), same);
  EXPECT_EQ(found.loggers.size(), 2u);
  EXPECT_EQ(found.sensors[0].logger, found.sensors[1].logger);
  EXPECT_NE(found.sensors[0].logger, found.sensors[2].logger);
}

}  // namespace
}  // namespace kinfer
