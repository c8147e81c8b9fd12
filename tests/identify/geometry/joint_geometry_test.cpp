// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/geometry/joint_geometry.hpp"

#include <gtest/gtest.h>

#include "identify/example_machine.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::general_hinge;

std::vector<SignalRow> readings() {
  return {{{-0.6}, {0}, {0}}, {{0.1}, {0}, {0}}, {{0.5}, {0}, {0}}, {{0.9}, {0}, {0}}};
}

void expect_same_pose(const Pose& a, const Pose& b) {
  EXPECT_LT((a.position - b.position).norm(), 1e-9);
  EXPECT_LT((a.rotation - b.rotation).norm(), 1e-9);
}

TEST(JointGeometry, ARevoluteJointRotatedByItsAngleIsTheChainItCameFrom) {
  const JointGeometry hinge = fit_revolute_geometry(general_hinge(), readings());
  for (const double angle : {-1.0, 0.0, 0.7})
    expect_same_pose(pose_at(hinge, angle), transform(general_hinge(), std::vector{angle}));
  EXPECT_NEAR(hinge.point_in_child.dot(hinge.axis_in_child), 0.0, 1e-12);
  EXPECT_LT((hinge.home * hinge.point_in_child - hinge.point_in_parent).norm(), 1e-9);
}

TEST(JointGeometry, TheAxisIsTheZAxisOfTheSecondLeaf) {
  const JointGeometry hinge = fit_revolute_geometry(general_hinge(), readings());
  const Pose parent_T_axis = transform(general_hinge().front());
  EXPECT_LT((hinge.axis_in_parent - parent_T_axis.rotation.col(2)).norm(), 1e-9);
  const Vec3 between = hinge.point_in_parent - parent_T_axis.position;
  EXPECT_LT(between.cross(hinge.axis_in_parent).norm(), 1e-9);
}

TEST(CanonicalRows, TenNumbersDescribeTheSameRevoluteJoint) {
  const Vec3 axes[] = {Vec3(0.3, -0.5, 0.8), Vec3(0, 0, 1),        Vec3(0, 0, -1),
                       Vec3(1, 0, 0),        Vec3(0.02, -0.01, 1), Vec3(0.01, 0.03, -1)};
  for (const Vec3& in_parent : axes)
    for (const Vec3& in_child : axes) {
      JointGeometry hinge;
      hinge.axis_in_parent = in_parent.normalized();
      hinge.axis_in_child = in_child.normalized();
      hinge.home.rotation = rotation_between(in_child, in_parent).toRotationMatrix();
      hinge.point_in_parent = Vec3(0.4, -1.2, 0.7);
      hinge.point_in_child = Vec3(-0.3, 0.2, 0.6);
      hinge.home.position = hinge.point_in_parent - hinge.home.rotation * hinge.point_in_child;
      auto rows = canonical_dh_rows(hinge);
      EXPECT_EQ(rows[2].a, 0.0);
      EXPECT_EQ(rows[2].alpha, 0.0);
      for (const auto& row : rows) EXPECT_LT(std::abs(row.d), 30.0) << "lengths stay those of the machine";
      for (const double angle : {0.0, 0.8}) {
        auto moved = rows;
        moved[1].theta += angle;
        expect_same_pose(transform(moved[0]) * transform(moved[1]) * transform(moved[2]), pose_at(hinge, angle));
      }
    }
}

TEST(Merged, IsTheSameProductWithFewerLeaves) {
  const std::vector<DhLeaf> split{{.d = 0.3},
                                  {.theta = 0.2, .a = 0.5},
                                  {.alpha = 0.4, .a = 0.1},
                                  {.theta_signal = 0},
                                  {.a = 0.7},
                                  {.d = 0.1, .a = 0.2},
                                  {}};
  const auto fewer = merge_leaves(split);
  EXPECT_EQ(fewer.size(), 2u);
  for (const double angle : {-0.4, 1.1})
    expect_same_pose(transform(fewer, std::vector{angle}), transform(split, std::vector{angle}));
}

TEST(Merged, RandomTreesKeepTheirProduct) {
  DhBreed breed(DhLeafOperators({.signals = 2}), {.min = 1, .max = 5, .max_leaves = 8});
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const auto factors = leaves(breed.random(Rng(seed)));
    const std::vector<double> signals{0.3, -0.8};
    const auto fewer = merge_leaves(factors);
    ASSERT_LE(fewer.size(), factors.size());
    expect_same_pose(transform(fewer, signals), transform(factors, signals));
  }
}

}  // namespace
}  // namespace kinfer
