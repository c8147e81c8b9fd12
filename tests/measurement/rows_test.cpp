// SPDX-License-Identifier: Apache-2.0
// Rows that arrive out of order, and sensors whose clocks are off.
#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/measurement/rows/clock_alignment.hpp"
#include "kinfer/measurement/rows/row_order.hpp"

namespace kinfer {
namespace {

constexpr double period = 0.005;

InsSample sample_at(double time) {
  InsSample sample{.time = time, .acceleration = Vec3::Zero(), .angular_velocity = Vec3(std::sin(3.0 * time), 0, 0)};
  sample.has_acceleration = sample.has_angular_velocity = true;
  return sample;
}

InsRow row_at(double time, std::size_t sensors) {
  return {.time = time, .sensors = std::vector<InsSample>(sensors, sample_at(time))};
}

/// What comes out, kept.
struct Kept {
  std::vector<InsRow> rows{};
  InsRowSink sink = [this](const InsRow& row) -> Result<void> {
    rows.push_back(row);
    return {};
  };
};

TEST(RowOrder, SortsWhatIsLateByLessThanTheDelay) {
  Rng rng(3);
  std::vector<std::pair<double, double>> arrivals;  // when, of which time
  for (int i = 0; i < 1000; ++i) arrivals.emplace_back(period * i + 0.05 * rng.uniform(), period * i);
  std::ranges::sort(arrivals);
  RowOrder order(0.05 + period);
  Kept kept;
  for (const auto& [when, time] : arrivals) ASSERT_TRUE(order.add(row_at(time, 1), kept.sink));
  ASSERT_TRUE(order.finish(kept.sink));
  EXPECT_EQ(order.dropped(), 0);
  ASSERT_EQ(kept.rows.size(), 1000u);
  for (std::size_t i = 0; i < kept.rows.size(); ++i) EXPECT_EQ(kept.rows[i].time, period * static_cast<double>(i));
}

TEST(RowOrder, PassesRowsAtOnceWithoutADelay) {
  RowOrder order(0.0);
  Kept kept;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(order.add(row_at(period * i, 2), kept.sink));
    EXPECT_EQ(kept.rows.size(), static_cast<std::size_t>(i + 1));
  }
}

TEST(RowOrder, DropsAndCountsWhatComesTooLate) {
  RowOrder order(0.01);
  Kept kept;
  for (const double time : {0.0, 0.1, 0.05, 0.2}) ASSERT_TRUE(order.add(row_at(time, 1), kept.sink));
  ASSERT_TRUE(order.finish(kept.sink));
  EXPECT_EQ(order.dropped(), 0) << "0.05 s was still before what had been passed on";
  for (const double time : {0.15, 0.2}) ASSERT_TRUE(order.add(row_at(time, 1), kept.sink));
  EXPECT_EQ(order.dropped(), 2);
  EXPECT_EQ(kept.rows.size(), 4u);
}

TEST(RowOrder, MakesOneRowOfTheSensorsOfOneTime) {
  InsRow first = row_at(1.0, 2), second = row_at(1.0, 2);
  first.sensors[1] = {.time = 1.0};
  second.sensors[0] = {.time = 1.0};
  RowOrder order(0.02);
  Kept kept;
  ASSERT_TRUE(order.add(first, kept.sink));
  ASSERT_TRUE(order.add(second, kept.sink));
  ASSERT_TRUE(order.finish(kept.sink));
  ASSERT_EQ(kept.rows.size(), 1u);
  EXPECT_TRUE(kept.rows[0].sensors[0].has_angular_velocity);
  EXPECT_TRUE(kept.rows[0].sensors[1].has_angular_velocity);
}

TEST(ClockAlignment, ChangesNothingWhereClocksAreRight) {
  ClockAlignment clocks({0.0, 1e-5});
  EXPECT_FALSE(clocks.has_effect());
  Kept kept;
  ASSERT_TRUE(clocks.add(row_at(1.0, 2), kept.sink));
  EXPECT_EQ(kept.rows.size(), 1u);
}

TEST(ClockAlignment, BringsSamplesToTheTimesOfTheirRows) {
  for (const double offset : {-0.043, -0.04, -0.0021, 0.0013, 0.01, 0.037}) {
    ClockAlignment clocks({0.0, offset});
    Kept kept;
    for (int i = 0; i < 400; ++i) {
      InsRow row = row_at(period * i, 2);
      row.sensors[1] = sample_at(row.time + offset);  // taken then, stamped with the row's time
      ASSERT_TRUE(clocks.add(row, kept.sink));
    }
    const double waits = static_cast<double>(400 - kept.rows.size()) * period;
    EXPECT_LE(waits, std::max(0.0, -offset) + 2.0 * period) << offset;
    ASSERT_TRUE(clocks.finish(kept.sink));
    ASSERT_EQ(kept.rows.size(), 400u) << "a row per row";
    int compared = 0;
    for (const InsRow& row : kept.rows) {
      EXPECT_EQ(row.sensors[0].angular_velocity.x(), std::sin(3.0 * row.time));
      if (!row.sensors[1].has_angular_velocity) continue;
      ++compared;
      EXPECT_NEAR(row.sensors[1].angular_velocity.x(), std::sin(3.0 * row.time), 9.0 / 8.0 * period * period + 1e-12);
    }
    EXPECT_GT(compared, 385);
  }
}

TEST(ClockAlignment, DoesNotWaitForALostSensor) {
  ClockAlignment clocks({0.0, -0.04});
  Kept kept;
  for (int i = 0; i < 400; ++i) {
    InsRow row = row_at(period * i, 2);
    if (row.time > 1.0) row.sensors[1] = {.time = row.time};
    ASSERT_TRUE(clocks.add(row, kept.sink));
  }
  EXPECT_GT(kept.rows.size(), 400u - 40u);
  EXPECT_FALSE(kept.rows.back().sensors[1].has_angular_velocity);
}

}  // namespace
}  // namespace kinfer
