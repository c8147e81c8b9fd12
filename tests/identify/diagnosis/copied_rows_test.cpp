// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/copied_rows.hpp"

#include <gmock/gmock.h>

#include "kinfer/base/rng.hpp"

namespace kinfer::identify {
namespace {

InsRecording noisy_recording(std::size_t rows) {
  Rng rng(3);
  InsSensor sensor{.name = "a", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  InsLogger logger{.name = "a.csv", .time = {}};
  for (std::size_t row = 0; row < rows; ++row) {
    logger.time.push_back(0.01 * static_cast<double>(row));
    for (TriadColumns* triad : {&sensor.acceleration, &sensor.angular_velocity})
      for (auto& axis : triad->axis) axis.push_back(static_cast<float>(rng.normal()));
  }
  sensor.faults.assign(rows, 0);
  return {.loggers = {logger}, .sensors = {sensor}, .remarks = {}};
}

/// The rows from `from` on repeat those of the beginning.
InsRecording with_copy(InsRecording recording, std::size_t from, std::size_t rows) {
  for (TriadColumns* triad : {&recording.sensors[0].acceleration, &recording.sensors[0].angular_velocity})
    for (auto& axis : triad->axis)
      for (std::size_t row = 0; row < rows; ++row) axis[from + row] = axis[row];
  return recording;
}

TEST(CopiedRows, ALogJoinedWithItselfIsRefused) {
  const auto checked = refuse_copied_rows(with_copy(noisy_recording(2000), 1000, 1000));
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().what, testing::HasSubstr("1000 of 2000 rows, from 10.00 s on, are copies"));
}

TEST(CopiedRows, AFewRowsThatALoggerSentTwiceAreNot) {
  EXPECT_TRUE(refuse_copied_rows(with_copy(noisy_recording(2000), 1000, 100)));
}

TEST(CopiedRows, NoiseHoldsNone) {
  EXPECT_TRUE(refuse_copied_rows(noisy_recording(2000)));
}

TEST(CopiedRows, ARestWithoutNoiseIsNone) {
  InsRecording recording = noisy_recording(2000);
  for (TriadColumns* triad : {&recording.sensors[0].acceleration, &recording.sensors[0].angular_velocity})
    for (auto& axis : triad->axis) std::fill(axis.begin() + 500, axis.end(), 0.25f);
  EXPECT_TRUE(refuse_copied_rows(recording));
}

}  // namespace
}  // namespace kinfer::identify
