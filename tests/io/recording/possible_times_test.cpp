// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/possible_times.hpp"

#include <gmock/gmock.h>

namespace kinfer {
namespace {

InsRecording recording(double period, std::size_t rows) {
  InsRecording all;
  all.loggers.push_back({.name = "imu.csv", .time = {}});
  for (std::size_t i = 0; i < rows; ++i) all.loggers.front().time.push_back(period * static_cast<double>(i));
  return all;
}

TEST(PossibleTimes, MillisecondsThatAreSaidToBeSecondsAreRefused) {
  EXPECT_TRUE(check_times(recording(0.005, 1000)));
  InsRecording log = recording(5.0, 1000);
  log.loggers.front().states_unit = true;
  const auto checked = check_times(log);
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().what, ::testing::HasSubstr("t[ms]"));
}

TEST(PossibleTimes, MillisecondsWithoutAUnitAreForTheDiagnosisToConvert) {
  EXPECT_TRUE(check_times(recording(5.0, 1000)));
  EXPECT_FALSE(expect_seconds(recording(5.0, 1000)));
  EXPECT_TRUE(expect_seconds(recording(0.005, 1000)));
  EXPECT_FALSE(check_times(recording(1e12, 1000)));
}

TEST(PossibleTimes, RowsThatAreStampedSeveralAtOnceAreNotTooClose) {
  for (const std::size_t packet : {2U, 10U}) {
    InsRecording log = recording(0.005, 1000);
    std::vector<double>& time = log.loggers.front().time;
    for (std::size_t i = 0; i < time.size(); ++i)
      time[i] = time[i / packet * packet] + 1e-6 * static_cast<double>(i % packet);
    EXPECT_TRUE(check_times(log)) << packet;
    EXPECT_TRUE(expect_seconds(log)) << packet;
    time.push_back(1e9);
    EXPECT_FALSE(check_times(log)) << packet;
  }
}

TEST(PossibleTimes, OneRowYearsLaterIsRefused) {
  InsRecording log = recording(0.01, 1000);
  log.loggers.front().time.push_back(1e9);
  EXPECT_FALSE(check_times(log));
}

TEST(PossibleTimes, AGapOfAnHourIsNone) {
  InsRecording log = recording(0.01, 1000);
  for (double& time : log.loggers.front().time) time += time > 5.0 ? 3600.0 : 0.0;
  EXPECT_TRUE(check_times(log));
}

}  // namespace
}  // namespace kinfer
