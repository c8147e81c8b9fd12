// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "kinfer/measurement/merge_pose_sets.hpp"
#include "kinfer/measurement/split.hpp"

namespace kinfer {
namespace {

PoseSet three_rows() {
  PoseSet set;
  set.joint_names = {"J1"};
  set.joints = (MatrixXd(1, 3) << 10, 20, 30).finished();
  set.points = {{.row = 0, .target = -1, .position = Vec3(0, 0, 1), .sd = {}},
                {.row = 2, .target = -1, .position = Vec3(0, 0, 3), .sd = {}}};
  set.orientations = {{1, Quat(0, 1, 0, 0)}};
  set.sockets = {"left", "right"};
  set.contacts = {{2, 1}};
  set.pairs = {{0, 2, 0.5}};
  set.line = {2, 3, 4};
  return set;
}

TEST(MergePoseSets, RowsOfTheSecondSetComeAfterAndAreLabelledHoldout) {
  PoseSet second = three_rows();
  second.sockets = {"right", "new"};
  const PoseSet all = merge_pose_sets(three_rows(), second);
  EXPECT_EQ(all.rows(), 6);
  EXPECT_EQ(all.joints(0, 3), 10);
  EXPECT_EQ(all.points.back().row, 5);
  EXPECT_EQ(all.pairs.back().other, 5);
  EXPECT_EQ(all.sockets[all.contacts.back().socket], "new");
  EXPECT_EQ(std::count(all.set.begin(), all.set.end(), SplitLabel::holdout), 3);
}

TEST(PositionSd, GrowsWithTheDistanceFromTheOrigin) {
  EXPECT_DOUBLE_EQ(position_sd({.sigma = 10e-6, .ppm = 5.0}, Vec3(0, 3, 4)), 35e-6);
}

TEST(Folds, EveryRowIsHeldOutExactlyOnce) {
  for (const int count : {5, 17, 100}) {
    std::vector<int> held(count, 0);
    for (const Split& split : folds(count, 5, Rng(3))) {
      EXPECT_EQ(split.train.size() + split.holdout.size(), static_cast<std::size_t>(count));
      for (const int row : split.holdout) ++held[row];
    }
    EXPECT_EQ(held, std::vector<int>(count, 1));
  }
}

TEST(RandomSplit, KeepsAtLeastOneRowOnEachSide) {
  EXPECT_EQ(random_split(2, 0.01, Rng(1)).holdout.size(), 1u);
  EXPECT_EQ(random_split(2, 0.99, Rng(1)).train.size(), 1u);
  EXPECT_EQ(random_split(100, 0.25, Rng(1)).holdout.size(), 25u);
}

}  // namespace
}  // namespace kinfer
