// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/ins_screening.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/angle.hpp"
#include "support/carried_sensor.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedSensor;

CarriedSensor noisy() {
  static const SensorModel grade = *sensor_grade("industrial");
  return carried({.pace = 1.5, .grade = &grade});
}

TEST(Screening, AFaultlessRecordingHasNoFlags) {
  for (const char* name : {"noise", "industrial", "consumer"}) {
    const SensorModel grade = *sensor_grade(name);
    const CarriedSensor c = carried({.grade = &grade});
    EXPECT_EQ(std::ranges::count_if(c.sensor.faults, [](std::uint8_t bits) { return bits != 0; }), 0) << name;
  }
  const CarriedSensor perfect = carried({});
  EXPECT_EQ(std::ranges::count_if(perfect.sensor.faults, [](std::uint8_t bits) { return bits != 0; }), 0);
}

TEST(Screening, RowsAtAnyRangeAreClipped) {
  for (const float range : {static_cast<float>(125 * degree), 1.7f}) {
    CarriedSensor c = noisy();
    std::size_t beyond = 0;
    for (std::size_t row = 0; row < c.time.size(); ++row) {
      bool over = false;
      for (auto& axis : c.sensor.angular_velocity.axis) {
        over |= std::abs(axis[row]) >= range;
        axis[row] = std::clamp(axis[row], -range, range);
      }
      beyond += over;
    }
    flag_faults(c.sensor);
    ASSERT_GT(beyond, 100u);
    EXPECT_EQ(count(c.sensor, angular_velocity_clipped), beyond) << "range " << range;
  }
}

TEST(Screening, AConstantColumnIsNotClipped) {
  const std::array scales{2.0 * 9.80665, 4.0 * 9.80665};
  std::vector<float> column(2000, 25.0f);
  EXPECT_TRUE(find_clipped_rows(column, scales, 12.0).empty()) << "the logger's constant";
  for (std::size_t row = 0; row < 20; ++row) column[row] = 0.1f * static_cast<float>(row);
  EXPECT_TRUE(find_clipped_rows(column, scales, 12.0).empty()) << "a sensor that freezes after its start";
  column.assign(2000, static_cast<float>(scales[0]));
  EXPECT_FALSE(find_clipped_rows(column, scales, 12.0).empty()) << "at the end of a usual range";
}

TEST(Screening, RowsOfOtherSensorsInBetweenDoNotHideARange) {
  CarriedSensor c = noisy();
  std::vector<float> column;
  for (const float value : c.sensor.angular_velocity.axis[0]) {
    column.push_back(std::clamp(value, -1.0f, 1.0f));
    column.push_back(std::numeric_limits<float>::quiet_NaN());
  }
  std::size_t at_range = 0;
  for (const float value : column) at_range += std::abs(value) >= 1.0f;
  const auto clipped = find_clipped_rows(column, {}, 0.5);
  EXPECT_GT(at_range, 8u);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(clipped, true)), at_range);
}

TEST(Screening, SingleSpikesAreFoundAndNothingElse) {
  CarriedSensor c = noisy();
  for (const std::size_t row : {500u, 3000u, 6001u}) c.sensor.acceleration.axis[1][row] += 80.0f;
  c.sensor.angular_velocity.axis[2][4000] -= 20.0f;
  flag_faults(c.sensor);
  EXPECT_EQ(count(c.sensor, acceleration_spike), 3u);
  EXPECT_EQ(count(c.sensor, angular_velocity_spike), 1u);
  EXPECT_TRUE(c.sensor.faults[3000] & acceleration_spike);
  EXPECT_FALSE(sample(c.sensor, c.time, 3000).has_acceleration);
  EXPECT_TRUE(sample(c.sensor, c.time, 3000).has_angular_velocity);
}

TEST(Screening, ConsecutiveOutliersAndThoseAtTheEndsAreSpikesTooAndAStepIsNone) {
  CarriedSensor c = noisy();
  c.sensor.angular_velocity.axis[2][4000] -= 20.0f;
  c.sensor.angular_velocity.axis[2][4001] += 15.0f;
  for (std::size_t row = 2000; row < 2010; ++row) c.sensor.acceleration.axis[1][row] += 80.0f;
  for (const std::size_t row :
       {std::size_t{0}, std::size_t{5000}, std::size_t{5001}, std::size_t{5002}, c.time.size() - 1})
    c.sensor.angular_velocity.axis[0][row] += 12.0f;
  EXPECT_EQ((flag_faults(c.sensor), count(c.sensor, angular_velocity_spike)), 7u);
  EXPECT_EQ(count(c.sensor, acceleration_spike), 0u);
}

TEST(Screening, MissingAndImpossibleNumbersAreMissing) {
  CarriedSensor c = noisy();
  c.sensor.acceleration.axis[0][10] = std::nanf("");
  c.sensor.angular_velocity.axis[0][11] = 1e20f;
  for (auto& axis : c.sensor.field.axis) axis[12] = 0.0f;
  flag_faults(c.sensor);
  EXPECT_EQ(c.sensor.faults[10], acceleration_missing);
  EXPECT_TRUE(c.sensor.faults[11] & angular_velocity_missing);
  EXPECT_EQ(c.sensor.faults[12], field_missing);
}

TEST(Screening, DeathIsTheRowAfterTheLastThatCanBeUsed) {
  CarriedSensor c = noisy();
  EXPECT_EQ(find_usable_end(c.sensor), c.sensor.rows());
  for (auto& axis : c.sensor.acceleration.axis) std::fill(axis.begin() + 4321, axis.end(), 0.0f);
  flag_faults(c.sensor);
  EXPECT_EQ(find_usable_end(c.sensor), 4321u);
}

TEST(Recording, GapsAreWhereRowsAreFarApart) {
  const std::vector<double> time{0, 0.01, 0.02, 0.5, 0.51, 0.52, 0.56};
  EXPECT_NEAR(median_period(time), 0.01, 1e-12);
  const auto found = gaps(time);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].row, 3u);
  EXPECT_EQ(found[1].begin, 0.52);
  EXPECT_EQ(median_period(std::vector<double>{1.0}), 0.0);
  EXPECT_TRUE(gaps({}).empty());
}

}  // namespace
}  // namespace kinfer
