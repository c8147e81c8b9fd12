// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/geometry/link_estimates.hpp"

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

TEST(PinDistance, OfParallelAxesIsTheirDistanceWhateverSlidesAlongThem) {
  for (const double slide : {0.0, 7.0, -3.0}) {
    const LinkEstimate link = link_estimates(two_axes({0.3, 0.4, slide}, Vec3::UnitZ())).at(0);
    ASSERT_TRUE(link.pin);
    EXPECT_NEAR(link.pin->distance, 0.5, 1e-12);
    EXPECT_NEAR(link.pin->sd, 3e-3 * std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR((link.pin->direction - Vec3(0.6, 0.8, 0.0)).norm(), 0.0, 1e-12);
    EXPECT_NEAR(link.pin->direction_sd, 3e-3 * std::numbers::sqrt2 / 0.5, 1e-12);
    EXPECT_EQ(link.axis_angle, 0.0);
  }
}

TEST(PinDistance, OfNearlyParallelAxesIsTakenLevelWithTheSensor) {
  // The second axis leans by 10 mrad across the line of the pins: the closest points lie far from the sensor.
  const LinkEstimate link = link_estimates(two_axes({0.5, 0.1, 0.0}, {0.0, 0.01, 1.0})).at(0);
  ASSERT_TRUE(link.pin);
  EXPECT_NEAR(link.pin->distance, std::hypot(0.5, 0.1), 1e-4);
  EXPECT_NEAR(link.length, 0.5, 1e-12) << "the shortest distance is another";
  EXPECT_NEAR(link.axis_angle, 0.01, 1e-6);
}

TEST(PinDistance, OnlyAxesThatMayBeMeantParallelHaveOne) {
  const auto has_pins = [](double angle, double sd) {
    std::vector<JointEstimate> joints = two_axes({0.5, 0.1, 0.2}, {0.0, std::sin(angle), std::cos(angle)});
    joints[0].sd.axis_in_child = joints[1].sd.axis_in_parent = {sd, sd};
    return link_estimates(joints).at(0).pin.has_value();
  };
  EXPECT_TRUE(has_pins(0.02, 1e-3));
  EXPECT_FALSE(has_pins(0.2, 1e-3));
  EXPECT_TRUE(has_pins(0.2, 0.1)) << "a poorly known angle may be none";
  EXPECT_FALSE(has_pins(1.5, 0.1));
}

TEST(PinDistance, StandardDeviationsAreThoseOfDrawnAxes) {
  const std::vector<JointEstimate> truth = [] {
    std::vector<JointEstimate> joints = two_axes({0.4, -0.3, 0.6}, {0.004, -0.003, 1.0});
    joints[0].point_in_child = {0.1, 0.05, -0.3};
    joints[0].sd = {.axis_in_child = {4e-3, 1e-3}, .point_in_child = {2e-3, 5e-3}};
    joints[1].sd = {.axis_in_parent = {1e-3, 3e-3}, .point_in_parent = {4e-3, 1e-3}};
    return joints;
  }();
  Rng rng(5);
  const auto draw_across = [&](const Vec3& axis, const std::array<double, 2>& sd) -> Vec3 {
    const Vec3 first = any_perpendicular(axis);
    const double along_first = sd[0] * rng.normal(), along_second = sd[1] * rng.normal();
    return along_first * first + along_second * axis.cross(first);
  };
  const PinDistance expected = *link_estimates(truth).at(0).pin;
  const Vec3 across = Vec3::UnitZ().cross(expected.direction);
  std::vector<double> distances, angles;
  for (int i = 0; i < 20000; ++i) {
    std::vector<JointEstimate> drawn = truth;
    drawn[0].point_in_child += draw_across(truth[0].axis_in_child, truth[0].sd.point_in_child);
    drawn[0].axis_in_child =
        (truth[0].axis_in_child + draw_across(truth[0].axis_in_child, truth[0].sd.axis_in_child)).normalized();
    drawn[1].point_in_parent += draw_across(truth[1].axis_in_parent, truth[1].sd.point_in_parent);
    drawn[1].axis_in_parent =
        (truth[1].axis_in_parent + draw_across(truth[1].axis_in_parent, truth[1].sd.axis_in_parent)).normalized();
    const PinDistance pin = *link_estimates(drawn).at(0).pin;
    distances.push_back(pin.distance);
    angles.push_back(across.dot(pin.direction));
  }
  EXPECT_NEAR(standard_deviation(distances) / expected.sd, 1.0, 0.05);
  EXPECT_NEAR(standard_deviation(angles) / expected.direction_sd, 1.0, 0.05);
}

TEST(LinkEstimates, BetweenParallelAndSkewTheUncertaintyHoldsBoth) {
  std::vector<JointEstimate> joints = two_axes({0.5, 0.3, 0.0}, {0.0, 3e-3, 1.0});
  joints[0].sd.axis_in_child = joints[1].sd.axis_in_parent = {1e-3, 1e-3};
  const LinkEstimate link = link_estimates(joints).at(0);
  EXPECT_NEAR(link.length, 0.5, 1e-9);
  EXPECT_GT(link.sd, std::hypot(0.5, 0.3) - 0.5);
  joints[1].axis_in_parent = Vec3(0.0, 1e-4, 1.0).normalized();
  EXPECT_NEAR(link_estimates(joints).at(0).length, std::hypot(0.5, 0.3), 1e-4) << "parallel as far as is known";
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
