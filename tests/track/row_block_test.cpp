// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/rows/row_block.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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

/// Rows gathered into blocks of 20 ms: the rows in each that is complete.
std::vector<int> rows_of_blocks(RowBlock& block, const std::vector<double>& times) {
  std::vector<int> rows;
  for (const double time : times) {
    if (block.ends_before(time)) block.clear();
    block.add(row_at(time));
    if (!block.is_complete(0.02)) continue;
    rows.push_back(block.rows());
    block.clear();
  }
  return rows;
}

/// The blocks at the loss are shorter or longer; those that follow are as ever.
void expect_same_blocks_after(int before, int lost, double period) {
  std::vector<double> times;
  for (int k = 0; k < 100; ++k)
    if (k < before || k >= before + lost) times.push_back(1.0 + period * k);
  RowBlock block(1);
  const std::vector<int> rows = rows_of_blocks(block, times);
  ASSERT_GT(rows.size(), 10u);
  for (std::size_t i = 10; i < rows.size(); ++i)
    EXPECT_EQ(rows[i], std::lround(0.02 / period)) << before << " rows, then " << lost << " lost, block " << i;
  RowBlock last(block);
  last.clear();
  last.add(row_at(2.0 + period));
  EXPECT_NEAR(last.length(), period, 1e-9) << "the sampling period";
}

/// A step beyond 13 ms counted as the period for ever: each row was a block of its own from there on, and what lasts
/// over many blocks was averaged as if it were new in each.
TEST(RowBlock, IsAsLongAsBeforeAfterRowsAreLost) {
  for (const int before : {1, 2, 3, 20, 21, 22, 23}) {
    for (int lost = 1; lost < 7; ++lost) expect_same_blocks_after(before, lost, 0.005);
    expect_same_blocks_after(before, 1, 0.01);
    expect_same_blocks_after(before, 2, 0.01);
  }
}

TEST(RowBlock, AFirstRowLongBeforeTheOthersIsNoSamplingPeriod) {
  for (const int lost : {10, 30, 50}) expect_same_blocks_after(1, lost, 0.005);
}

TEST(RowBlock, FollowsAChangeOfTheSamplingRate) {
  std::vector<double> times;
  for (int k = 0; k < 100; ++k) times.push_back(0.0025 * k);
  for (int k = 0; k < 100; ++k) times.push_back(0.25 + 0.01 * k);
  for (int k = 0; k < 100; ++k) times.push_back(1.25 + 0.0025 * k);
  RowBlock block(1);
  const std::vector<int> rows = rows_of_blocks(block, times);
  EXPECT_EQ(rows[5], 8);
  EXPECT_EQ(rows[12 + 25], 2);
  EXPECT_EQ(rows[rows.size() - 2], 8);
}

TEST(RowBlock, SlowSamplingIsNoGap) {
  RowBlock block(1);
  for (const double time : {0.0, 0.2}) block.add(row_at(time));
  EXPECT_FALSE(block.ends_before(0.4));
}

}  // namespace
}  // namespace kinfer::track
