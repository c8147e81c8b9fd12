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

/// Its readings scatter by less than the tolerance of a commanded pose.
TEST(ValidationPlan, RepeatedMeasurementsOfOnePoseAreHeldOutTogether) {
  constexpr int poses = 20;
  PoseSet set = three_rows_of_each_pose(poses);
  for (DistanceMeasurement& wire : set.distances) wire.anchor = 0;
  Rng rng(2);
  for (double& q : set.joints.reshaped()) q += rng.uniform(-2e-5, 2e-5);
  for (const Split& fold : make_row_folds(set, 5, Rng(1)))
    for (int row = 0; row < poses; ++row) {
      EXPECT_EQ(contains(fold.holdout, row), contains(fold.holdout, row + poses));
      EXPECT_EQ(contains(fold.holdout, row), contains(fold.holdout, row + 2 * poses));
    }
}

TEST(ValidationPlan, BallBarsFromOneReferencePoseAreHeldOutApart) {
  PoseSet set = measured(er20(), paper2_poses(30, noise_free));
  set.points.clear();
  for (int row = 0; row < 30; row += 2) {
    set.joints.col(row) = set.joints.col(0);
    set.pairs.push_back({row, row + 1, 0.5});
  }
  const std::vector<Split> folds = make_row_folds(set, 5, Rng(1));
  ASSERT_EQ(folds.size(), 5U);
  for (const Split& fold : folds) EXPECT_EQ(fold.holdout.size(), 6U);
}

}  // namespace
}  // namespace kinfer
