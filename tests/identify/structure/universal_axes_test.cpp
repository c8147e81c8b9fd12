// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/universal_axes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/base/rng.hpp"

namespace kinfer {
using namespace identify;
namespace {

const Vec3 first_axis = Vec3(0.2, 0.9, -0.4).normalized(), second_axis = Vec3(0.7, 0.1, 0.8).normalized();
const Mat3 mounted = exp_so3(Vec3(0.4, -1.0, 0.3));

/// exp(first_axis q₁) M exp(second_axis q₂), turned further by errors.
std::vector<Mat3> two_axis_rotations(double amplitude, double error) {
  Rng rng(3);
  std::vector<Mat3> rotations;
  for (int i = 0; i < 800; ++i) {
    Vec3 errors;
    for (double& e : errors) e = error * rng.normal();
    const double t = 0.05 * i, q1 = amplitude * std::sin(0.9 * t), q2 = 0.7 * amplitude * std::sin(1.7 * t + 0.3);
    rotations.push_back(exp_so3(q1 * first_axis) * mounted * exp_so3(q2 * second_axis) * exp_so3(errors));
  }
  return rotations;
}

double sine(const Vec3& a, const Vec3& b) {
  return a.cross(b).norm();
}

TEST(UniversalAxes, AreFoundFromAnyStart) {
  const UniversalAxes axes = universal_axes(two_axis_rotations(0.8, 0.0), Mat3::Identity());
  EXPECT_LT(sine(axes.in_parent, first_axis), 3e-3);
  EXPECT_LT(sine(axes.in_child, second_axis), 3e-3);
  EXPECT_LT(axes.deviation, 1e-3);
}

/// Any two axes in the plane of small rotations keep their angle; nearly parallel ones say nothing of a joint.
TEST(UniversalAxes, OfSmallRotationsAreInclined) {
  constexpr double error = 2e-3;
  const UniversalAxes axes = universal_axes(two_axis_rotations(0.06, error), Mat3::Identity());
  EXPECT_LT(axes.deviation, 2.0 * error);
  EXPECT_GT(std::sin(axes.angle), 0.7);
  const Vec3 normal = first_axis.cross(mounted * second_axis).normalized();
  EXPECT_LT(std::abs(normal.dot(axes.in_parent)), 0.1) << "in the plane of the joint's axes";
}

}  // namespace
}  // namespace kinfer
