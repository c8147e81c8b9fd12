// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/pose_set.hpp"

#include <gtest/gtest.h>

namespace kinfer {
namespace {

/// Four rows, every list filled, with numbers that encode their row.
PoseSet four_rows() {
  PoseSet set;
  set.joint_names = {"a", "b"};
  set.joints = (MatrixXd(2, 4) << 0, 1, 2, 3, 10, 11, 12, 13).finished();
  set.commanded = set.joints.array() + 100;
  set.torques = set.joints.array() + 200;
  set.targets = {"s2"}, set.sockets = {"ball"}, set.planes = {"table"}, set.setups = {"A", "B"}, set.sweeps = {"J1"};
  for (int row = 0; row < 4; ++row) {
    set.points.push_back({row, -1, Vec3(row, 0, 0), Vec3(row, row, row)});
    set.orientations.push_back({row, Quat(1, row, 0, 0)});
    set.distances.push_back({row, row, 1.0 * row});
    set.contacts.push_back({row, 0});
    set.plane_contacts.push_back({row, 0});
    set.tilts.push_back({row, Vec3(0, 0, row)});
    set.setup.push_back(row % 2);
    set.sweep.push_back(row % 2 - 1);
    set.payload.push_back(row);
    set.temperature.push_back(20 + row);
    set.id.push_back(std::to_string(row));
    set.set.push_back(row % 2 ? SplitLabel::train : SplitLabel::holdout);
    set.line.push_back(row + 2);
  }
  set.pairs = {{0, 1, 0.5}, {1, 3, 0.7}};
  return set;
}

TEST(PoseSet, SelectedRowsKeepAllTheirMeasurements) {
  const PoseSet set = select(four_rows(), {3, 1});
  EXPECT_EQ(set.joints, (MatrixXd(2, 2) << 3, 1, 13, 11).finished());
  EXPECT_EQ(set.commanded(1, 0), 113);
  EXPECT_EQ(set.torques(0, 1), 201);
  ASSERT_EQ(set.points.size(), 2U);
  for (const PointMeasurement& point : set.points) {
    EXPECT_EQ(point.position.x(), set.joints(0, point.row));
    EXPECT_EQ(point.sd->x(), point.position.x());
  }
  for (const auto& measured : set.orientations) EXPECT_EQ(measured.orientation.x(), set.joints(0, measured.row));
  for (const auto& measured : set.distances) EXPECT_EQ(measured.distance, set.joints(0, measured.row));
  for (const auto& measured : set.tilts) EXPECT_EQ(measured.specific_force.z(), set.joints(0, measured.row));
  EXPECT_EQ(set.orientations.size() + set.distances.size() + set.tilts.size(), 6U);
  EXPECT_EQ(set.contacts.size() + set.plane_contacts.size(), 4U);
  EXPECT_EQ(set.payload, (std::vector<double>{3, 1}));
  EXPECT_EQ(set.temperature, (std::vector<double>{23, 21}));
  EXPECT_EQ(set.id, (std::vector<std::string>{"3", "1"}));
  EXPECT_EQ(set.set, (std::vector{SplitLabel::train, SplitLabel::train}));
  EXPECT_EQ(set.setup, (std::vector<int>{1, 1}));
  EXPECT_EQ(set.sweep, (std::vector<int>{0, 0}));
  EXPECT_EQ(set.line, (std::vector<int>{5, 3}));
  EXPECT_EQ(set.joint_names, four_rows().joint_names);
  EXPECT_EQ(set.targets, four_rows().targets);
  EXPECT_EQ(set.sockets, four_rows().sockets);
  EXPECT_EQ(set.planes, four_rows().planes);
  EXPECT_EQ(set.setups, four_rows().setups);
  EXPECT_EQ(set.sweeps, four_rows().sweeps);
}

TEST(PoseSet, APairIsKeptWhereBothOfItsRowsAre) {
  const PoseSet set = select(four_rows(), {3, 1});
  ASSERT_EQ(set.pairs.size(), 1U);
  EXPECT_EQ(set.pairs[0].row, 1);
  EXPECT_EQ(set.pairs[0].other, 0);
  EXPECT_EQ(set.pairs[0].distance, 0.7);
}

TEST(PoseSet, ARowThatIsDrawnTwiceCountsTwice) {
  const PoseSet set = select(four_rows(), {2, 2, 0});
  EXPECT_EQ(set.rows(), 3);
  EXPECT_EQ(set.points.size(), 3U);
  EXPECT_EQ(select(four_rows(), {0, 1, 1, 0}).pairs.size(), 2U);
}

TEST(PoseSet, AbsentColumnsStayAbsent) {
  PoseSet bare;
  bare.joints = MatrixXd::Zero(1, 3);
  const PoseSet set = select(bare, {2});
  EXPECT_EQ(set.rows(), 1);
  EXPECT_EQ(set.commanded.size() + set.torques.size(), 0);
  EXPECT_TRUE(set.payload.empty() && set.setup.empty() && set.id.empty() && set.set.empty());
  EXPECT_FALSE(has_measurements(set));
  EXPECT_TRUE(has_measurements(select(four_rows(), {0})));
}

}  // namespace
}  // namespace kinfer
