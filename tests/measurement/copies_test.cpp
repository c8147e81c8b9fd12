// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/copies.hpp"

#include <gtest/gtest.h>

namespace kinfer {
namespace {

using Groups = std::vector<std::vector<int>>;

/// Two joints; rows 0 and 2 are at one place, row 1 at another.
PoseSet rows_at_two_places() {
  PoseSet set;
  set.joints.resize(2, 3);
  set.joints << 0.1, 0.5, 0.1, 0.2, 0.6, 0.2;
  for (int row = 0; row < 3; ++row) set.points.push_back({row, -1, Vec3(row == 1 ? 2.0 : 1.0, 0.0, 0.0), {}});
  return set;
}

TEST(Copies, ACopyLosesItsMeasurementAndKeepsItsRow) {
  const PoseSet left = without_copies(rows_at_two_places());
  EXPECT_EQ(left.rows(), 3);
  ASSERT_EQ(left.points.size(), 2u);
  EXPECT_EQ(left.points[1].row, 1);
  EXPECT_EQ(groups_of_copies(rows_at_two_places()), (Groups{{0, 2}}));
}

TEST(Copies, ARepeatedPoseMeasuredAnewIsNoCopy) {
  PoseSet set = rows_at_two_places();
  set.points[2].position.y() = 1e-6;
  EXPECT_EQ(without_copies(set).points.size(), 3u);
  EXPECT_EQ(groups_of_copies(set), Groups{});
}

TEST(Copies, OnePoseAtTwoTemperaturesIsNoCopyAndUnknownOnesAreAlike) {
  PoseSet set = rows_at_two_places();
  set.temperature = {20.0, 20.0, 30.0};
  EXPECT_EQ(without_copies(set).points.size(), 3u);
  set.temperature.assign(3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(without_copies(set).points.size(), 2u);
}

TEST(Copies, OfAFittedAndAHeldOutRowTheFittedOneStays) {
  PoseSet set = rows_at_two_places();
  set.set = {SplitLabel::holdout, SplitLabel::train, SplitLabel::train};
  const PoseSet left = without_copies(set);
  ASSERT_EQ(left.points.size(), 2u);
  EXPECT_EQ(left.points[1].row, 2);
}

TEST(Copies, TwoStationsThatSeeOnePoseAreNoCopies) {
  PoseSet set = rows_at_two_places();
  set.points.clear();
  set.directions = {{0, 0, Vec3::UnitX()}, {2, 1, Vec3::UnitX()}};
  EXPECT_EQ(without_copies(set).directions.size(), 2u);
  set.directions[1].station = 0;
  EXPECT_EQ(without_copies(set).directions.size(), 1u);
}

}  // namespace
}  // namespace kinfer
