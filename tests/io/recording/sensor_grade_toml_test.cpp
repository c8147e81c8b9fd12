// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/recording/sensor_grade_toml.hpp"

namespace kinfer {
namespace {

TEST(SensorGradeToml, WritingThenReadingGivesEqualValues) {
  for (const std::string_view name : sensor_grade_names) {
    const SensorModel model = *sensor_grade(name);
    const auto back = parse_sensor_grade(format_sensor_grade(model), "grade.toml");
    ASSERT_TRUE(back) << back.error().what;
    EXPECT_EQ(back->name, model.name);
    const InstrumentModel* a[] = {&model.accelerometer, &model.gyroscope, &model.magnetometer};
    const InstrumentModel* b[] = {&back->accelerometer, &back->gyroscope, &back->magnetometer};
    for (int i = 0; i < 3; ++i) {
      EXPECT_DOUBLE_EQ(a[i]->noise_density, b[i]->noise_density);
      EXPECT_DOUBLE_EQ(a[i]->bias_sd, b[i]->bias_sd);
      EXPECT_DOUBLE_EQ(a[i]->instability, b[i]->instability);
      EXPECT_DOUBLE_EQ(a[i]->scale_sd, b[i]->scale_sd);
      EXPECT_DOUBLE_EQ(a[i]->range, b[i]->range);
      EXPECT_DOUBLE_EQ(a[i]->resolution, b[i]->resolution);
    }
  }
}

TEST(SensorGradeToml, DataSheetUnitsAreConverted) {
  const auto model = parse_sensor_grade(
      "name = \"mine\"\nunits = { acceleration = \"g\", angular_rate = \"deg/s\" }\n"
      "[gyroscope]\nnoise_density = 0.005\nrange = 2000\n[accelerometer]\nbias = 1e-3\n",
      "grade.toml");
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_NEAR(model->gyroscope.noise_density, 0.005 * degree, 1e-15);
  EXPECT_NEAR(model->gyroscope.range, 2000 * degree, 1e-12);
  EXPECT_NEAR(model->accelerometer.bias_sd, 9.80665e-3, 1e-15);
}

TEST(SensorGradeToml, ErrorsNameFileAndLine) {
  const auto wrong = [](const char* text) { return parse_sensor_grade(text, "grade.toml").error().what; };
  EXPECT_EQ(wrong("[gyroscope]\nnoise_density = -1\n"),
            "grade.toml:2: gyroscope: \"noise_density\": expected a number that is not negative");
  EXPECT_EQ(wrong("units = { angular_rate = \"rpm\" }\n"),
            "grade.toml:1: units: \"angular_rate\": expected an angular rate (rad/s, deg/s), found \"rpm\"");
  EXPECT_EQ(wrong("[gyroscope]\nbias = 1e9\n"),
            "grade.toml:2: gyroscope: \"bias\": 1e+09 rad/s is not possible for an angular rate (at most 1e+06 rad/s)");
  EXPECT_EQ(wrong("[accelerometer]\nscale = 1e6\n"),
            "grade.toml:2: accelerometer: \"scale\": 1e+06 is not possible for a gain (at most 10000)");
  EXPECT_NE(wrong("[gyroscope]\nnoise = 1\n").find("grade.toml:2: gyroscope: "), std::string::npos);
}

}  // namespace
}  // namespace kinfer
