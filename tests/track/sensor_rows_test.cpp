// SPDX-License-Identifier: Apache-2.0
// Rows as they arrive: gathered into blocks, and watched for sensors that fail.
#include <gtest/gtest.h>

#include "kinfer/track/faults/sensor_health.hpp"
#include "kinfer/track/faults/thresholds.hpp"
#include "kinfer/track/rows/row_block.hpp"
#include "support/random.hpp"

namespace kinfer::track {
namespace {

InsSample sample_of(const Vec3& rate, const Vec3& force) {
  InsSample s;
  s.angular_velocity = rate, s.acceleration = force;
  s.has_angular_velocity = s.has_acceleration = true;
  return s;
}

InsRow random_row(double time, std::size_t sensors, Rng& rng) {
  InsRow row{.time = time};
  for (std::size_t s = 0; s < sensors; ++s) {
    const Vec3 rate = test::random_vector(rng);
    row.sensors.push_back(sample_of(rate, test::random_vector(rng)));
  }
  return row;
}

TEST(RowBlock, IsTheMeanOfWhatWasMeasured) {
  Rng rng(2);
  RowBlock block(2);
  Vec3 rates = Vec3::Zero(), forces = Vec3::Zero();
  int rate_count = 0;
  for (int i = 0; i < 4; ++i) {
    InsRow row = random_row(1.0 + 0.005 * i, 2, rng);
    if (i == 1) row.sensors[1].angular_velocity_clipped = true;
    if (i == 2) row.sensors[1].has_angular_velocity = false;
    if (i == 0 || i == 3) rates += row.sensors[1].angular_velocity, ++rate_count;
    forces += row.sensors[1].acceleration;
    block.add(row);
  }
  const BlockMeasurement mean = block.mean();
  EXPECT_EQ(block.rows(), 4);
  EXPECT_NEAR(mean.time, 1.0075, 1e-12);
  EXPECT_NEAR(mean.length, 0.02, 1e-12) << "four rows stand for four periods";
  EXPECT_EQ(mean.sensors[1].rate_count, rate_count);
  EXPECT_LT((mean.sensors[1].rate - rates / rate_count).norm(), 1e-14);
  EXPECT_LT((mean.sensors[1].force - forces / 4).norm(), 1e-14);
}

TEST(RowBlock, IsCompleteWhereAnotherRowWouldMakeItTooLong) {
  Rng rng(3);
  for (const double period : {0.01, 0.005, 0.0025}) {
    RowBlock block(1);
    int rows = 0;
    while (!block.is_complete(0.02) && rows < 100) block.add(random_row(5.0 + period * rows++, 1, rng));
    EXPECT_EQ(rows, std::lround(0.02 / period)) << period;
    EXPECT_NEAR(block.mean().length, 0.02, 1e-9);
    block.clear();
    EXPECT_EQ(block.rows(), 0);
    EXPECT_FALSE(block.is_complete(0.02));
  }
}

TEST(RowBlock, KeepsNothingOfTheBlockBefore) {
  Rng rng(4);
  RowBlock used(1), fresh(1);
  for (int i = 0; i < 3; ++i) used.add(random_row(0.01 * i, 1, rng));
  used.clear();
  for (int i = 3; i < 6; ++i) {
    const InsRow row = random_row(0.01 * i, 1, rng);
    used.add(row), fresh.add(row);
  }
  EXPECT_EQ(used.mean().sensors[0].rate, fresh.mean().sensors[0].rate);
  EXPECT_EQ(used.mean().time, fresh.mean().time);
}

TEST(HealthWatch, ASensorWithoutSamplesIsLostSinceItsLastOne) {
  Rng rng(5);
  HealthWatch watch(2);
  for (int i = 0; i < 200; ++i) {
    InsRow row = random_row(0.005 * i, 2, rng);
    if (i > 100) row.sensors[1] = {};
    watch.add(row);
    EXPECT_FALSE(watch[0].lost || watch[0].stuck || watch[0].clipped);
    if (i != 140) {  // at the limit itself rounding decides
      EXPECT_EQ(watch[1].lost, 0.005 * i - 0.5 > lost_after) << i;
    }
  }
  EXPECT_NEAR(watch[1].lost_since, 0.5, 1e-12);
  watch.add(random_row(1.0, 2, rng));
  EXPECT_FALSE(watch[1].lost) << "it is back";
}

TEST(HealthWatch, TheSameSampleAgainAndAgainIsStuckSinceItBegan) {
  Rng rng(6);
  HealthWatch watch(1);
  const InsRow held = random_row(0.0, 1, rng);
  bool was_stuck = false;
  for (int i = 0; i < 120; ++i) {
    InsRow row = random_row(0.005 * i, 1, rng);
    if (i >= 40) row.sensors = held.sensors;
    watch.add(row);
    was_stuck = was_stuck || watch[0].stuck;
    if (i < 40 + stuck_rows) {
      EXPECT_FALSE(watch[0].stuck) << i;
    }
  }
  EXPECT_TRUE(was_stuck);
  EXPECT_NEAR(watch[0].stuck_since, 0.2, 1e-12);
  EXPECT_FALSE(watch[0].lost) << "samples come";
}

TEST(HealthWatch, ARepeatedRowNowAndThenIsNoFault) {
  Rng rng(7);
  HealthWatch watch(1);
  InsRow row = random_row(0.0, 1, rng);
  for (int i = 0; i < 400; ++i) {
    if (i % 4 == 0) row = random_row(0.0, 1, rng);  // a sensor of a quarter of the logger's rate
    row.time = 0.0025 * i;
    watch.add(row);
    EXPECT_FALSE(watch[0].stuck);
  }
}

TEST(HealthWatch, ClippingIsRememberedForAMoment) {
  Rng rng(8);
  HealthWatch watch(1);
  for (int i = 0; i < 300; ++i) {
    InsRow row = random_row(0.005 * i, 1, rng);
    row.sensors[0].angular_velocity_clipped = i == 50;
    watch.add(row);
    const double since = 0.005 * (i - 50);
    if (std::abs(since - clipped_memory) > 1e-9) {
      EXPECT_EQ(watch[0].clipped, since >= 0.0 && since < clipped_memory);
    }
  }
}

}  // namespace
}  // namespace kinfer::track
