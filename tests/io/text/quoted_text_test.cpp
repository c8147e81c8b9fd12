// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/quoted_text.hpp"

#include <gtest/gtest.h>

#include "kinfer/io/recording/sensor_grade_toml.hpp"
#include "kinfer/io/text/toml_reader.hpp"
#include "kinfer/io/tracking/tracking_model_toml.hpp"
#include "support/example_tracking_model.hpp"

namespace kinfer {
namespace {

const std::vector<std::string> names{"plain", "a \"quoted\" one", "back\\slash", "tab\tand\nline", "\x7f", "µT", ""};

TEST(QuotedText, IsReadBackFromToml) {
  for (const std::string& name : names) {
    SensorModel grade;
    grade.name = name;
    const auto again = parse_sensor_grade(format_sensor_grade(grade), "grade.toml");
    ASSERT_TRUE(again) << again.error().what;
    EXPECT_EQ(again->name, name);
  }
}

TEST(QuotedText, BytesThatAreNoUtf8AreWrittenAsNumbers) {
  EXPECT_EQ(quoted_text("a\xff"), "\"a_x00FF_\"");
}

TEST(QuotedText, SensorsOfATrackingModelKeepTheirNames) {
  TrackingModel model = test::example_tracking_model(3);
  for (std::size_t i = 0; i + 1 < names.size(); ++i) model.sensors[i].name = names[i];
  const auto again = parse_tracking_model(format_tracking_model(model), "track.toml");
  ASSERT_TRUE(again) << again.error().what;
  for (std::size_t i = 0; i + 1 < names.size(); ++i) EXPECT_EQ(again->sensors[i].name, names[i]);
}

}  // namespace
}  // namespace kinfer
