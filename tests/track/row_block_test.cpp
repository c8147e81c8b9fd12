// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/rows/row_block.hpp"

#include <gtest/gtest.h>

namespace kinfer::track {
namespace {

InsRow row_at(double time) {
  InsRow row{.time = time};
  row.sensors.resize(1);
  row.sensors[0].time = time;
  row.sensors[0].has_angular_velocity = row.sensors[0].has_acceleration = true;
  return row;
}

/// The mean of two rows on both sides of a gap is that of no time.
TEST(RowBlock, EndsBeforeAGapAndNotBeforeTheNextRow) {
  RowBlock block(1);
  for (const double time : {0.0, 0.01}) block.add(row_at(time));
  block.clear();
  block.add(row_at(0.02));
  EXPECT_FALSE(block.ends_before(0.03));
  EXPECT_FALSE(block.ends_before(0.04)) << "one row is missing";
  EXPECT_TRUE(block.ends_before(0.3));
  EXPECT_NEAR(block.mean().time, 0.02, 1e-12);
  EXPECT_NEAR(block.mean().length, 0.01, 1e-12);
}

/// Taken as that of the block's middle, the last row of a sensor before it is lost was a false alarm.
TEST(RowBlock, ASensorThatIsNotInAllRowsHasAMeanTimeOfItsOwn) {
  RowBlock block(1);
  for (const double time : {0.0, 0.005, 0.010, 0.015}) {
    InsRow row = row_at(time);
    row.sensors[0].has_angular_velocity = time > 0.007;
    block.add(row);
  }
  const BlockSample& sample = block.mean().sensors[0];
  EXPECT_NEAR(sample.rate_time, 0.0125 - 0.0075, 1e-12);
  EXPECT_EQ(sample.force_time, 0.0);
}

TEST(RowBlock, TheFirstRowBeyondAGapIsCompleteAlone) {
  RowBlock block(1);
  for (const double time : {0.0, 0.01}) block.add(row_at(time));
  block.clear();
  block.add(row_at(0.3));
  EXPECT_TRUE(block.is_complete(0.1));
  EXPECT_EQ(block.mean().time, 0.3);
  EXPECT_NEAR(block.mean().length, 0.01, 1e-12);
  block.clear();
  block.add(row_at(0.31));
  EXPECT_FALSE(block.is_complete(0.1));
}

TEST(RowBlock, SlowSamplingIsNoGap) {
  RowBlock block(1);
  for (const double time : {0.0, 0.2}) block.add(row_at(time));
  EXPECT_FALSE(block.ends_before(0.4));
}

}  // namespace
}  // namespace kinfer::track
