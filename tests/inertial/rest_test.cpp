// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/rest/rest.hpp"

#include <gtest/gtest.h>

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
