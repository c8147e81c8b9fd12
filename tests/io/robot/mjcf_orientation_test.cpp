// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/mjcf/mjcf_orientation.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "kinfer/geometry/random.hpp"

namespace kinfer {
namespace {

using std::numbers::pi;
const MjcfUnits radians{.degrees = false, .euler_sequence = "xyz"};

Mat3 rotation(MjcfOrientation kind, std::vector<double> numbers, const MjcfUnits& units = radians) {
  const auto r = rotation_of(kind, numbers, units);
  EXPECT_TRUE(r.has_value());
  return r.value_or(Mat3::Zero());
}

double difference(const Mat3& a, const Mat3& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

TEST(MjcfOrientation, EveryKindMeansWhatMujocosReferenceSays) {
  using enum MjcfOrientation;
  EXPECT_LT(difference(rotation(quat, {2, 0, 0, 2}), rot_z(pi / 2)), 1e-15);
  EXPECT_LT(difference(rotation(axisangle, {0, 5, 0, 90}, {.degrees = true}), rot_y(pi / 2)), 1e-15);
  Mat3 axes;
  axes << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // x along y, y along -x
  EXPECT_LT(difference(rotation(xyaxes, {0, 3, 0, -1, 5, 0}), axes), 1e-15);
  EXPECT_LT(difference(rotation(zaxis, {0, -2, 0}), rot_x(pi / 2)), 1e-15);
  EXPECT_LT(difference(rotation(zaxis, {0, 0, -1}), rot_x(pi)), 1e-15);
  EXPECT_LT(difference(rotation(euler, {0.1, 0.2, 0.3}), rot_x(0.1) * rot_y(0.2) * rot_z(0.3)), 1e-15);
  EXPECT_LT(difference(rotation(euler, {0.1, 0.2, 0.3}, {false, "XYZ"}), rot_z(0.3) * rot_y(0.2) * rot_x(0.1)), 1e-15);
  EXPECT_LT(difference(rotation(euler, {0.1, 0.2, 0.3}, {false, "zXy"}), rot_x(0.2) * rot_z(0.1) * rot_y(0.3)), 1e-15);
}

TEST(MjcfOrientation, NumbersWithoutADirectionAreNone) {
  using enum MjcfOrientation;
  EXPECT_FALSE(rotation_of(quat, std::vector<double>{0, 0, 0, 0}, radians));
  EXPECT_FALSE(rotation_of(axisangle, std::vector<double>{0, 0, 0, 1}, radians));
  EXPECT_FALSE(rotation_of(zaxis, std::vector<double>{0, 0, 0}, radians));
  EXPECT_FALSE(rotation_of(xyaxes, std::vector<double>{1, 0, 0, -2, 0, 0}, radians));
  EXPECT_TRUE(rotation_of(quat, std::vector<double>{1e300, 0, 0, 1e300}, radians)) << "its square overflows";
}

TEST(MjcfOrientation, TheNumbersOfARotationMeanItInEveryKindThatCanHoldIt) {
  Rng rng(3);
  for (const bool degrees : {true, false})
    for (const char* sequence : {"xyz", "XYZ", "zXy", "zyz", "XZX", "yZx"})
      for (const MjcfOrientationTraits& row : mjcf_orientations) {
        if (row.kind == MjcfOrientation::zaxis) continue;
        const MjcfUnits units{degrees, sequence};
        const std::vector<double> like(row.numbers, 0.3);
        for (int i = 0; i < 50; ++i) {
          const Mat3 r = exp_so3(2.0 * normal_vector(rng));
          const auto numbers = numbers_of(row.kind, r, like, units);
          ASSERT_TRUE(numbers) << row.attribute << " " << sequence;
          EXPECT_LT(difference(rotation(row.kind, *numbers, units), r), 1e-13) << row.attribute << " " << sequence;
        }
      }
}

TEST(MjcfOrientation, TheNumbersStayNearThoseOfTheFile) {
  using enum MjcfOrientation;
  const Mat3 turn = exp_so3({1e-3, -2e-3, 1e-3});
  const auto expect_near = [&](MjcfOrientation kind, const std::vector<double>& old, const MjcfUnits& units) {
    const auto numbers = numbers_of(kind, rotation(kind, old, units) * turn, old, units);
    ASSERT_TRUE(numbers);
    for (std::size_t k = 0; k < old.size(); ++k)
      EXPECT_NEAR((*numbers)[k], old[k], units.degrees ? 1.0 : 0.01) << static_cast<int>(kind) << " " << k;
  };
  expect_near(quat, {-0.5, 0.5, 0.5, -0.5}, radians);
  expect_near(axisangle, {0, 0, -1, 270}, {.degrees = true});
  expect_near(axisangle, {0, 0.6, 0.8, -1}, radians);
  expect_near(euler, {200, 110, -300}, {.degrees = true});
  expect_near(euler, {4, -1, 3}, {false, "zxz"});
}

TEST(MjcfOrientation, GimbalLockIsHeldAndWhatAKindCannotHoldIsNot) {
  using enum MjcfOrientation;
  const std::vector<double> zeros{0, 0, 0};
  for (const double off : {0.0, 1e-12, 1e-8, 1e-5}) {
    const Mat3 locked = rot_x(0.4) * rot_y(pi / 2 - off) * rot_z(-0.3);
    const auto angles = numbers_of(euler, locked, zeros, radians);
    ASSERT_TRUE(angles) << off;
    EXPECT_LT(difference(rotation(euler, *angles), locked), 1e-13) << off;
  }
  EXPECT_FALSE(numbers_of(euler, rot_z(0.1), zeros, {false, "xxy"}));
  EXPECT_FALSE(numbers_of(euler, rot_y(0.1), zeros, {false, "XzX"})) << "X X z in the end";
  EXPECT_FALSE(numbers_of(zaxis, rot_z(0.1), zeros, radians));
  EXPECT_TRUE(numbers_of(zaxis, rot_x(0.1), zeros, radians));
}

}  // namespace
}  // namespace kinfer
