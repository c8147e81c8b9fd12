// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/loops/closing_joint.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinfer {
using namespace identify;
namespace {

const Vec3 point_in_first(0.4, -0.2, 0.1), point_in_second(-0.3, 0.1, 0.05);
const Vec3 axis_in_first = Vec3(1.0, 2.0, -1.0).normalized(), axis_in_second = Vec3(0.0, 0.6, 0.8);

/// Poses of a body that rotates about a pin of the first one.
std::vector<Pose> pinned(double play) {
  std::vector<Pose> poses;
  for (int i = 0; i < 60; ++i) {
    const double angle = 0.7 * std::sin(0.3 * i), wobble = play * std::cos(1.7 * i);
    Pose pose;
    pose.rotation = frame_with_z_along(axis_in_first) * rot_z(angle) * frame_with_z_along(axis_in_second).transpose();
    pose.position = point_in_first - pose.rotation * point_in_second + wobble * Vec3(0.0, 1.0, 2.0) / std::sqrt(5.0);
    poses.push_back(pose);
  }
  return poses;
}

double distance_to_line(const Vec3& point, const Vec3& on_line, const Vec3& axis) {
  return (point - on_line).cross(axis).norm();
}

TEST(ClosingJoint, OfAPinIsFoundInBothBodies) {
  const ClosingJoint found = fit_closing_joint(pinned(0.0));
  EXPECT_LT(found.joint.parent_R_axis.col(2).cross(axis_in_first).norm(), 1e-9);
  EXPECT_LT(found.joint.child_R_axis.col(2).cross(axis_in_second).norm(), 1e-9);
  EXPECT_GT(found.joint.parent_R_axis.col(2).dot(axis_in_first) * found.joint.child_R_axis.col(2).dot(axis_in_second),
            0.0);
  EXPECT_LT(distance_to_line(found.joint.point_in_parent, point_in_first, axis_in_first), 1e-4);
  EXPECT_LT(distance_to_line(found.joint.point_in_child, point_in_second, axis_in_second), 1e-4);
  EXPECT_LT(found.gap, 1e-4);
  EXPECT_LT(found.misalignment, 1e-6);
  EXPECT_NEAR(found.rotation, 0.7 / std::sqrt(2.0), 0.05);
}

TEST(ClosingJoint, TheGapIsThePlayAcrossTheAxis) {
  const double play = 3e-3;  // [m] amplitude, along (0, 1, 2): perpendicular to the axis
  EXPECT_NEAR(fit_closing_joint(pinned(play)).gap, play / std::sqrt(2.0), 0.1 * play);
}

}  // namespace
}  // namespace kinfer
