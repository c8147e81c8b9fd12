// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/rest/rest.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "kinfer/inertial/activity.hpp"
#include "kinfer/inertial/sensor_grading.hpp"
#include "support/carried_sensor.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedSensor;

TEST(RestPeriod, TheRestsBeforeAndAfterAMotionAreFound) {
  for (const char* name : {"noise", "industrial", "consumer"}) {
    const SensorModel grade = *sensor_grade(name);
    const CarriedSensor c = carried({.grade = &grade});  // moves from 4 s to 36 s
    const auto found = rest_periods(c.sensor, c.time);
    ASSERT_EQ(found.size(), 2u) << name;
    EXPECT_LT(found[0].begin, 0.2);
    EXPECT_NEAR(found[0].end, 4.2, 0.3);
    EXPECT_NEAR(found[1].begin, 35.8, 0.8);
    EXPECT_GT(found[1].end, 39.8);
  }
}

TEST(RestPeriod, TheMeanAngularVelocityAtRestIsTheBias) {
  const SensorModel grade = *sensor_grade("industrial");
  const CarriedSensor c = carried({.grade = &grade, .seed = 7});
  const InstrumentErrors truth = sample_instrument_errors(grade.gyroscope, Rng(7).stream(3));
  const RestBias bias = bias_at_rest(rest_periods(c.sensor, c.time));
  const double accuracy = 4 * grade.gyroscope.instability + grade.gyroscope.resolution / 4;
  EXPECT_LT((bias.mean - truth.bias).cwiseAbs().maxCoeff(), accuracy);
  EXPECT_NEAR(bias.seconds, 7.6, 0.8);
}

TEST(RestPeriod, ASensorThatNeverStopsHasNone) {
  const CarriedSensor c = carried({.rest = -10.0});
  EXPECT_TRUE(rest_periods(c.sensor, c.time).empty());
  EXPECT_EQ(bias_at_rest({}).seconds, 0.0);
}

TEST(RestPeriod, ALargeGyroBiasIsNoMotion) {
  CarriedSensor c = carried({});                                        // moves from 4 s to 36 s
  for (float& rate : c.sensor.angular_velocity.axis[1]) rate += 0.07f;  // 4 °/s
  const auto found = rest_periods(c.sensor, c.time);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].angular_velocity.y(), 0.07, 1e-3);
}

/// The samples of two sensors in turns, each in rows of its own.
InsRecording interleaved(const CarriedSensor& first, const CarriedSensor& second) {
  constexpr float missing = std::numeric_limits<float>::quiet_NaN();
  InsRecording recording;
  recording.loggers.push_back({"log", {}});
  recording.sensors = {first.sensor, second.sensor};
  recording.sensors[0].field = recording.sensors[1].field = {};
  for (std::size_t s = 0; s < 2; ++s)
    for (auto* columns : {&recording.sensors[s].acceleration, &recording.sensors[s].angular_velocity})
      for (auto& axis : columns->axis) {
        std::vector<float> spread;
        for (const float value : axis) {
          spread.push_back(s == 0 ? value : missing);
          spread.push_back(s == 0 ? missing : value);
        }
        axis = spread;
      }
  for (std::size_t row = 0; row < 2 * first.time.size(); ++row)
    recording.loggers[0].time.push_back(0.0025 * static_cast<double>(row));
  for (InsSensor& sensor : recording.sensors) flag_faults(sensor);
  return recording;
}

TEST(Activity, OfInterleavedSensorsIsThatOfEachByItself) {
  const CarriedSensor c = carried({.rest = 8.0});
  InsRecording alone;
  alone.loggers.push_back({"log", c.time});
  alone.sensors = {c.sensor, c.sensor};
  const auto expected = detect_activity(alone), found = detect_activity(interleaved(c, c));
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const std::size_t s : {0u, 1u})
      EXPECT_NEAR(found[i].sensors[s].rms_rate, expected[i].sensors[s].rms_rate,
                  1e-3 + 0.01 * expected[i].sensors[s].rms_rate);
}

TEST(Activity, ReportsWhichSegmentMovesWhen) {
  InsRecording recording;
  const CarriedSensor still = carried({.rest = 100.0}), moving = carried({.rest = 8.0});
  recording.loggers.push_back({"log", still.time});
  recording.sensors = {still.sensor, moving.sensor};
  const auto spans = detect_activity(recording);
  ASSERT_EQ(spans.size(), 3u);
  EXPECT_FALSE(spans[1].sensors[0].moves);
  EXPECT_TRUE(spans[1].sensors[1].moves);
  EXPECT_NEAR(spans[1].begin, 8.5, 0.6);
  EXPECT_NEAR(spans[1].end, 31.5, 0.6);
}

TEST(SensorGrading, EachGradeIsRecognisedByItsOwnRecording) {
  for (const std::string_view name : sensor_grade_names) {
    int right = 0;
    for (int seed = 1; seed <= 8; ++seed) {
      const SensorModel grade = *sensor_grade(name);
      const CarriedSensor c = carried({.grade = &grade, .seed = seed});
      const auto found = sensor_statistics(c.sensor, c.time, rest_periods(c.sensor, c.time));
      right += estimate_sensor_model(found).name == name;
      EXPECT_NEAR(found.rate_density.mean() / grade.gyroscope.noise_density, 1.0, 0.2) << name << " seed " << seed;
    }
    EXPECT_GE(right, 7) << name << ": of 8 recordings";
  }
}

TEST(SensorGrading, AGradeDoesNotDependOnTheLengthOfTheRecording) {
  const SensorModel grade = *sensor_grade("industrial");
  const CarriedSensor c = carried({.seconds = 1200.0, .sampling_rate = 50.0, .grade = &grade});
  const auto found = sensor_statistics(c.sensor, c.time, rest_periods(c.sensor, c.time));
  EXPECT_EQ(estimate_sensor_model(found).name, "industrial");
  EXPECT_LT(found.scale_error, 1.5e-3);
}

TEST(SensorGrading, WithoutRestTheConservativeGradeIsUsed) {
  EXPECT_EQ(estimate_sensor_model(SensorStatistics{}).name, "consumer");
}

}  // namespace
}  // namespace kinfer
