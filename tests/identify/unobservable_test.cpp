// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/unobservable.hpp"

#include <gtest/gtest.h>

#include "kinfer/words/identification/unobservable.hpp"

namespace kinfer {
using namespace identify;
namespace {

std::vector<UnobservableKind> kinds(const JointEstimate& joint) {
  std::vector<UnobservableKind> list;
  for (const Unobservable& u : joint.unobservable) list.push_back(u.kind);
  return list;
}

std::vector<UnobservableKind> kinds_of(JointEstimate joint) {
  std::vector<JointEstimate> joints{std::move(joint)};
  list_unobservable(joints);
  return kinds(joints.front());
}

TEST(Unobservable, EveryJointTypeLeavesItsOwnFreeChoice) {
  using enum UnobservableKind;
  const auto of_type = [](EstimatedJointType type) { return kinds_of({.parent = "a", .child = "b", .type = type}); };
  EXPECT_EQ(of_type(EstimatedJointType::revolute), std::vector{point_on_axis});
  EXPECT_EQ(of_type(EstimatedJointType::prismatic), std::vector{axis_position});
  EXPECT_EQ(of_type(EstimatedJointType::rigid), std::vector{joint_axis});
  EXPECT_TRUE(of_type(EstimatedJointType::spherical).empty());
  EXPECT_TRUE(of_type(EstimatedJointType::universal).empty());
}

TEST(Unobservable, TheNumberOfDirectionsTellsWhichPartOfAPoint) {
  using enum UnobservableKind;
  const std::vector<Vec3> axes{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const UnobservableKind expected[] = {point_along, point_across, point};
  for (std::size_t n = 1; n <= 3; ++n) {
    std::vector<JointEstimate> joints{{.parent = "a", .child = "b", .type = EstimatedJointType::spherical}};
    joints[0].unobservable_in_child.assign(axes.begin(), axes.begin() + static_cast<std::ptrdiff_t>(n));
    list_unobservable(joints);
    ASSERT_EQ(joints[0].unobservable.size(), 1U);
    EXPECT_EQ(joints[0].unobservable[0].kind, expected[n - 1]);
    EXPECT_EQ(joints[0].unobservable[0].sensor, "b");
    EXPECT_EQ(joints[0].unobservable[0].directions.size(), n);
  }
}

TEST(Unobservable, ConsecutiveParallelAxesShareTheirOffset) {
  const auto second_joint = [](const Vec3& axis) {
    std::vector<JointEstimate> joints{{.parent = "a", .child = "b"}, {.parent = "b", .child = "c"}};
    joints[1].axis_in_parent = axis;
    list_unobservable(joints);
    return joints[1];
  };
  const Vec3 anti_parallel = -(Vec3::UnitZ() + 0.04 * Vec3::UnitX()).normalized();
  for (const Vec3& axis : {Vec3(Vec3::UnitZ()), anti_parallel}) {
    const JointEstimate joint = second_joint(axis);
    ASSERT_EQ(joint.unobservable.back().kind, UnobservableKind::offset_split);
    EXPECT_EQ(joint.unobservable.back().other_joint, "a-b");
  }
  EXPECT_EQ(second_joint((Vec3::UnitZ() + 0.06 * Vec3::UnitX()).normalized()).unobservable.back().kind,
            UnobservableKind::point_on_axis);
}

TEST(Unobservable, OfAnUnknownAzimuthIsThePlaceOfTheJointsBehindIt) {
  std::vector<JointEstimate> joints{{.parent = "a", .child = "b"}, {.parent = "b", .child = "c"}};
  joints[1].axis_in_parent = Vec3::UnitX();
  list_unobservable(joints);
  EXPECT_EQ(kinds(joints[1]), std::vector{UnobservableKind::point_on_axis});
  joints[0].azimuth_unobservable = true;
  list_unobservable(joints);
  ASSERT_EQ(kinds(joints[1]), (std::vector{UnobservableKind::place_about_axis, UnobservableKind::point_on_axis}));
  EXPECT_EQ(words::unobservable_sentences(joints[1]).front(),
            "the direction and the place of the axis in b about the axis of a-b, which is vertical and keeps its "
            "direction: record once more on a slope, or with a magnetometer, as for the azimuth of b");
}

TEST(Unobservable, IsListedAnewAtEachCall) {
  std::vector<JointEstimate> joints{{.parent = "a", .child = "b"}};
  joints[0].azimuth_unobservable = true;
  list_unobservable(joints);
  list_unobservable(joints);
  EXPECT_EQ(kinds(joints[0]), (std::vector{UnobservableKind::azimuth, UnobservableKind::point_on_axis}));
}

TEST(UnobservableWords, StateTheDirectionAcrossTwoOthersAndTheRemedy) {
  std::vector<JointEstimate> joints{{.parent = "a", .child = "b"}};
  joints[0].unobservable_in_parent = {Vec3::UnitX(), Vec3::UnitY()};
  list_unobservable(joints);
  const auto sentences = words::unobservable_sentences(joints[0]);
  ASSERT_EQ(sentences.size(), 2U);
  EXPECT_EQ(sentences[0],
            "shifts of the axis in a across [0.00 0.00 1.00]: rotate this segment about more directions, or "
            "measure with a tape");
  EXPECT_EQ(sentences[1], "the joint's point along its own axis: any point of the axis will do");
}

}  // namespace
}  // namespace kinfer
