// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/sample_digest.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"

namespace kinfer {
namespace {

/// A sensor that swings, with the noise of an industrial one.
InsRecording swinging(std::size_t rows, std::uint64_t seed, double noise = 0.008) {
  InsRecording recording;
  recording.loggers = {{"log", {}}};
  InsSensor sensor{.name = "imu", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  Rng rng(seed);
  for (std::size_t row = 0; row < rows; ++row) {
    const double t = 0.01 * static_cast<double>(row);
    recording.loggers[0].time.push_back(t);
    for (std::size_t k = 0; k < 3; ++k) {
      sensor.acceleration.axis[k].push_back(
          static_cast<float>(5.0 + std::sin(t + static_cast<double>(k)) + noise * rng.normal()));
      sensor.angular_velocity.axis[k].push_back(
          static_cast<float>(std::cos(t + static_cast<double>(k)) + 0.1 * noise * rng.normal()));
    }
    sensor.faults.push_back(0);
  }
  recording.sensors = {sensor};
  return recording;
}

/// Rows from `first` on.
InsRecording part_of(const InsRecording& recording, std::size_t first, std::size_t count) {
  InsRecording part = recording;
  const auto cut = [&](auto& list) {
    list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(first));
    list.resize(count);
  };
  cut(part.loggers[0].time), cut(part.sensors[0].faults);
  for (auto* triad : {&part.sensors[0].acceleration, &part.sensors[0].angular_velocity})
    for (auto& axis : triad->axis) cut(axis);
  return part;
}

TEST(SampleDigest, ACopyIsKnownInAnyFormAndInPart) {
  const InsRecording log = swinging(20000, 1);
  const std::string digest = sample_digest(log);
  EXPECT_DOUBLE_EQ(shared_samples(digest, sample_digest(log)), 1.0);
  InsRecording other = log;
  for (double& t : other.loggers[0].time) t = 1.001 * t + 1.7e9;
  other.sensors[0].name = "renamed";
  for (auto& axis : other.sensors[0].acceleration.axis)
    for (float& value : axis) value = std::round(value * 1e6f) / 1e6f;  // fewer digits
  EXPECT_GT(shared_samples(digest, sample_digest(other)), 0.8);
  for (const std::size_t count : {2000U, 10000U, 19000U}) {
    const std::string part = sample_digest(part_of(log, 500, count));
    EXPECT_GT(shared_samples(digest, part), 0.95) << count;
    EXPECT_DOUBLE_EQ(shared_samples(digest, part), shared_samples(part, digest));
  }
}

TEST(SampleDigest, AnotherRecordingOfTheSameMotionIsNew) {
  const std::string digest = sample_digest(swinging(20000, 1));
  EXPECT_EQ(shared_samples(digest, sample_digest(swinging(20000, 2))), 0.0);
  const InsRecording log = swinging(20000, 1);
  EXPECT_EQ(shared_samples(sample_digest(part_of(log, 0, 10000)), sample_digest(part_of(log, 10000, 10000))), 0.0);
  InsRecording still = part_of(log, 0, 1000);
  for (auto* triad : {&still.sensors[0].acceleration, &still.sensors[0].angular_velocity})
    for (auto& axis : triad->axis) std::ranges::fill(axis, 1.0f);
  EXPECT_EQ(sample_digest(still), "") << "what never changes is like any other";
}

TEST(SampleDigest, WhatIsNoDigestHoldsNothing) {
  EXPECT_EQ(shared_samples("", ""), 0.0);
  EXPECT_EQ(shared_samples("not hexadecimal", sample_digest(swinging(1000, 1))), 0.0);
}

}  // namespace
}  // namespace kinfer
