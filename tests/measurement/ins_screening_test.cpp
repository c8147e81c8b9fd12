#include "kinfer/measurement/ins_screening.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

TEST(Screening, a_good_recording_has_no_marks) {
  for (const char* name : {"noise", "industrial", "consumer"}) {
    const SensorModel grade = *sensor_grade(name);
    const CarriedSensor c = carried({.grade = &grade});
    EXPECT_EQ(std::ranges::count_if(c.sensor.faults, [](std::uint8_t bits) { return bits != 0; }), 0) << name;
  }
  const CarriedSensor perfect = carried({});
  EXPECT_EQ(std::ranges::count_if(perfect.sensor.faults, [](std::uint8_t bits) { return bits != 0; }), 0);
}

TEST(Screening, rows_at_any_range_are_clipped) {
  for (const float range : {static_cast<float>(125 * degree), 1.7f}) {
    CarriedSensor c = noisy();
    std::size_t beyond = 0;
    for (std::size_t row = 0; row < c.time.size(); ++row) {
      bool over = false;
      for (auto& axis : c.sensor.rate.axis) {
        over |= std::abs(axis[row]) >= range;
        axis[row] = std::clamp(axis[row], -range, range);
      }
      beyond += over;
    }
    mark_faults(c.sensor);
    ASSERT_GT(beyond, 100u);
    EXPECT_EQ(count(c.sensor, rate_clipped), beyond) << "range " << range;
  }
}

TEST(Screening, single_spikes_are_found_and_nothing_else) {
  CarriedSensor c = noisy();
  for (const std::size_t row : {500u, 3000u, 6001u}) c.sensor.acceleration.axis[1][row] += 80.0f;
  c.sensor.rate.axis[2][4000] -= 20.0f;
  mark_faults(c.sensor);
  EXPECT_EQ(count(c.sensor, acceleration_spike), 3u);
  EXPECT_EQ(count(c.sensor, rate_spike), 1u);
  EXPECT_TRUE(c.sensor.faults[3000] & acceleration_spike);
  EXPECT_FALSE(sample(c.sensor, c.time, 3000).has_acceleration);
  EXPECT_TRUE(sample(c.sensor, c.time, 3000).has_rate);
}

TEST(Screening, wild_rows_together_and_at_the_ends_are_spikes_too_and_a_step_is_none) {
  CarriedSensor c = noisy();
  c.sensor.rate.axis[2][4000] -= 20.0f;
  c.sensor.rate.axis[2][4001] += 15.0f;
  for (std::size_t row = 2000; row < 2010; ++row) c.sensor.acceleration.axis[1][row] += 80.0f;
  for (const std::size_t row :
       {std::size_t{0}, std::size_t{5000}, std::size_t{5001}, std::size_t{5002}, c.time.size() - 1})
    c.sensor.rate.axis[0][row] += 12.0f;
  EXPECT_EQ((mark_faults(c.sensor), count(c.sensor, rate_spike)), 7u);
  EXPECT_EQ(count(c.sensor, acceleration_spike), 0u);
}

TEST(Screening, missing_and_impossible_numbers_are_missing) {
  CarriedSensor c = noisy();
  c.sensor.acceleration.axis[0][10] = std::nanf("");
  c.sensor.rate.axis[0][11] = 1e20f;
  for (auto& axis : c.sensor.field.axis) axis[12] = 0.0f;
  mark_faults(c.sensor);
  EXPECT_EQ(c.sensor.faults[10], acceleration_missing);
  EXPECT_TRUE(c.sensor.faults[11] & rate_missing);
  EXPECT_EQ(c.sensor.faults[12], field_missing);
}

TEST(Screening, death_is_the_row_after_the_last_that_can_be_used) {
  CarriedSensor c = noisy();
  EXPECT_EQ(death_row(c.sensor), c.sensor.rows());
  for (auto& axis : c.sensor.acceleration.axis) std::fill(axis.begin() + 4321, axis.end(), 0.0f);
  mark_faults(c.sensor);
  EXPECT_EQ(death_row(c.sensor), 4321u);
}

TEST(Recording, gaps_are_where_rows_are_far_apart) {
  const std::vector<double> time{0, 0.01, 0.02, 0.5, 0.51, 0.52, 0.56};
  EXPECT_NEAR(typical_period(time), 0.01, 1e-12);
  const auto found = gaps(time);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].row, 3u);
  EXPECT_EQ(found[1].begin, 0.52);
  EXPECT_EQ(typical_period(std::vector<double>{1.0}), 0.0);
  EXPECT_TRUE(gaps({}).empty());
}

}  // namespace
}  // namespace kinfer
