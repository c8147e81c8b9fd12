// SPDX-License-Identifier: Apache-2.0
// Rows whose measurements belong together are never split between fit and validation.
#include "kinfer/calibrate/validation/validation_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

/// Each pose in three rows, with the wire of another anchor in each.
PoseSet three_rows_of_each_pose(int poses) {
  const PoseSet measured_once = measured(er20(), paper2_poses(poses, noise_free));
  std::vector<int> rows;
  for (int row = 0; row < 3 * poses; ++row) rows.push_back(row % poses);
  PoseSet set = select(measured_once, rows);
  set.points.clear();
  for (int row = 0; row < set.rows(); ++row) set.distances.push_back({row, row / poses, 1.0});
  return set;
}

bool contains(const std::vector<int>& rows, int row) {
  return std::find(rows.begin(), rows.end(), row) != rows.end();
}

TEST(ValidationPlan, RowsOfOnePoseWithDifferentAnchorsAreHeldOutTogether) {
  constexpr int poses = 20;
  const PoseSet set = three_rows_of_each_pose(poses);
  const std::vector<Split> folds = make_row_folds(set, 5, Rng(1));
  ASSERT_EQ(folds.size(), 5U);
  for (const Split& fold : folds)
    for (int row = 0; row < poses; ++row) {
      EXPECT_EQ(contains(fold.holdout, row), contains(fold.holdout, row + poses));
      EXPECT_EQ(contains(fold.holdout, row), contains(fold.holdout, row + 2 * poses));
    }
}

TEST(ValidationPlan, RepeatedMeasurementsFromOneAnchorAreHeldOutAlone) {
  PoseSet set = three_rows_of_each_pose(20);
  for (DistanceMeasurement& wire : set.distances) wire.anchor = 0;
  bool split = false;
  for (const Split& fold : make_row_folds(set, 5, Rng(1)))
    for (int row = 0; row < 20; ++row) split |= contains(fold.holdout, row) != contains(fold.holdout, row + 20);
  EXPECT_TRUE(split);
}

}  // namespace
}  // namespace kinfer
