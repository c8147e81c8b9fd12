// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/sampling_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinfer/simulate/log_faults.hpp"
#include "support/carried_sensor.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedSensor;

/// One moving sensor, 100 Hz, 40 s.
InsRecording one_sensor() {
  static const SensorModel grade = *sensor_grade("industrial");
  const CarriedSensor c = carried({.seconds = 40.0, .sampling_rate = 100.0, .grade = &grade});
  InsRecording recording;
  recording.loggers = {{"log", c.time}};
  recording.sensors = {c.sensor};
  return recording;
}

/// rms difference of the times, a common offset apart.
double off(const std::vector<double>& times, const std::vector<double>& truth) {
  return time_scatter(times, truth);
}

TEST(SamplingGrid, IsFoundBehindJitter) {
  const InsRecording sound = one_sensor(), late = with_stamp_jitter(sound, 2e-3, Rng(3));
  const auto grid = fit_sampling_grid(late.loggers[0].time, LostSamples::anywhere);
  ASSERT_TRUE(grid);
  EXPECT_NEAR(grid->period, 0.01, 1e-7);
  EXPECT_LT(off(grid->time, sound.loggers[0].time), 1e-4);
  EXPECT_NEAR(time_scatter(late.loggers[0].time, grid->time), 2e-3, 2e-4);
}

TEST(SamplingGrid, IsFoundBehindPackets) {
  const InsRecording sound = one_sensor(), late = with_packets(sound, 12);
  const auto grid = fit_sampling_grid(late.loggers[0].time, LostSamples::in_gaps_only);
  ASSERT_TRUE(grid);
  EXPECT_NEAR(grid->period, 0.01, 1e-5);
  EXPECT_LT(off(grid->time, sound.loggers[0].time), 5e-4);
}

TEST(SamplingGrid, CountsLostSamplesAndGaps) {
  const InsRecording sound = one_sensor();
  const std::vector<double> all = with_stamp_jitter(sound, 1e-3, Rng(4)).loggers[0].time;
  std::vector<double> stamps, truth;
  Rng rng(5);
  for (std::size_t row = 0; row < all.size(); ++row) {
    if (rng.uniform() < 0.1 || (row > 1500 && row < 1900)) continue;
    stamps.push_back(all[row]);
    truth.push_back(sound.loggers[0].time[row]);
  }
  const auto grid = fit_sampling_grid(stamps, LostSamples::anywhere);
  ASSERT_TRUE(grid);
  EXPECT_NEAR(grid->period, 0.01, 1e-6);
  EXPECT_LT(off(grid->time, truth), 3e-4);
}

TEST(SamplingGrid, OfAFewRowsIsNotFitted) {
  const std::vector<double> stamps{0.0, 0.1, 0.2, 0.31};
  EXPECT_FALSE(fit_sampling_grid(stamps, LostSamples::anywhere));
}

TEST(TimeEvidence, FavoursTheTimesAtWhichTheSignalsAreSmooth) {
  const InsRecording sound = one_sensor();
  const InsSensor& sensor = sound.sensors[0];
  const auto &truth = sound.loggers[0].time, late = with_stamp_jitter(sound, 2e-3, Rng(3)).loggers[0].time;
  EXPECT_TRUE(compare_times(sensor, late, truth).favours_other());
  EXPECT_FALSE(compare_times(sensor, truth, late).favours_other());
  EXPECT_FALSE(compare_times(sensor, truth, truth).favours_other());
}

TEST(TimeEvidence, DecidesNothingAboutASensorAtRest) {
  static const SensorModel grade = *sensor_grade("industrial");
  const CarriedSensor c =
      carried({.seconds = 20.0, .sampling_rate = 100.0, .swing = 0.0, .reach = 0.0, .grade = &grade});
  InsRecording still;
  still.loggers = {{"log", c.time}};
  still.sensors = {c.sensor};
  const auto late = with_stamp_jitter(still, 2e-3, Rng(3)).loggers[0].time;
  EXPECT_FALSE(compare_times(c.sensor, late, c.time).favours_other());
  EXPECT_FALSE(compare_times(c.sensor, c.time, late).favours_other());
}

}  // namespace
}  // namespace kinfer
