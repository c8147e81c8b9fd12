// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/identify/geometry/identified_chain.hpp"

namespace kinfer {
using namespace identify;
namespace {

using enum EstimatedJointType;

/// Joints a-b and b-c with given axis lines in b.
std::vector<JointEstimate> two_axes(const Vec3& point, const Vec3& axis) {
  std::vector<JointEstimate> joints{{.parent = "a", .child = "b"}, {.parent = "b", .child = "c"}};
  joints[0].axis_in_child = Vec3::UnitZ();
  joints[1].point_in_parent = point;
  joints[1].axis_in_parent = axis.normalized();
  joints[0].sd.point_in_child = joints[1].sd.point_in_parent = {3e-3, 3e-3};
  return joints;
}

TEST(LinkEstimates, AreTheShortestDistanceOfTwoAxes) {
  const auto length = [](const Vec3& point, const Vec3& axis) { return link_estimates(two_axes(point, axis)).at(0); };
  const LinkEstimate parallel = length({0.3, 0.4, 7.0}, Vec3::UnitZ());
  EXPECT_NEAR(parallel.length, 0.5, 1e-12);
  EXPECT_NEAR(parallel.sd, 3e-3 * std::numbers::sqrt2, 1e-12);
  EXPECT_EQ(parallel.segment, "b");
  EXPECT_EQ(parallel.from, "a-b");
  EXPECT_EQ(parallel.to, "b-c");
  EXPECT_NEAR(length({0.3, 0.4, 7.0}, -Vec3::UnitZ()).length, 0.5, 1e-12);
  EXPECT_NEAR(length({0.3, 0.4, 7.0}, Vec3::UnitX()).length, 0.4, 1e-12) << "skew at a right angle";
  EXPECT_NEAR(length({0.3, 0.0, 7.0}, Vec3::UnitX()).length, 0.0, 1e-12) << "they intersect";
}

TEST(LinkEstimates, TheAngleBetweenNearlyParallelAxesAddsToTheUncertainty) {
  std::vector<JointEstimate> joints = two_axes({0.5, 0.1, 2.0}, {0.0, 0.02, 1.0});
  const double without = link_estimates(joints).at(0).sd;
  joints[0].sd.axis_in_child = joints[1].sd.axis_in_parent = {1e-3, 1e-3};
  const double with = link_estimates(joints).at(0).sd;
  EXPECT_NEAR(without, 3e-3 * std::numbers::sqrt2, 1e-12);
  EXPECT_GT(with, without);
  std::vector<JointEstimate> crossed = joints;
  crossed[1].axis_in_parent = Vec3::UnitY();
  EXPECT_LT(link_estimates(crossed).at(0).sd, with) << "crossed axes do not mind";
}

TEST(LinkEstimates, ACentreHasADistanceToAnAxisAndToACentre) {
  std::vector<JointEstimate> joints = two_axes({0.3, 0.4, 1.2}, Vec3::UnitX());
  joints[1].type = spherical;
  EXPECT_NEAR(link_estimates(joints).at(0).length, 0.5, 1e-12) << "of the centre to the axis along z";
  joints[0].type = spherical;
  EXPECT_NEAR(link_estimates(joints).at(0).length, 1.3, 1e-12) << "of both centres";
}

TEST(LinkEstimates, JointsWithoutARotationAxisOfTheirOwnHaveNone) {
  for (const EstimatedJointType type : {prismatic, universal, rigid}) {
    std::vector<JointEstimate> joints = two_axes({0.3, 0.4, 0.0}, Vec3::UnitZ());
    joints[1].type = type;
    EXPECT_TRUE(link_estimates(joints).empty()) << name(type);
  }
  EXPECT_TRUE(link_estimates({}).empty());
  std::vector<JointEstimate> apart{{.parent = "a", .child = "b"}, {.parent = "a", .child = "c"}};
  EXPECT_TRUE(link_estimates(apart).empty()) << "two joints of the root";
}

}  // namespace
}  // namespace kinfer
