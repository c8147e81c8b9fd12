// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/fit_comparison.hpp"

#include <gtest/gtest.h>

#include "support/random_bodies.hpp"

namespace kinfer {
namespace {

TEST(LargestDifference, IsThatOfTheAxisLinesWhateverPointsAndSensesDescribeThem) {
  Rng rng(4);
  InsBodies bodies{{.sensor = 0}, test::random_revolute_body(0, 1, rng), test::random_prismatic_body(1, 2, rng)};
  InsBodies same = bodies;
  same[1].point_in_parent += 2.0 * same[1].parent_R_axis.col(2);  // along the axis
  same[1].parent_R_axis = same[1].parent_R_axis * rot_x(3.14159265358979323846);
  same[2].point_in_parent += Vec3(1.0, 0.0, 0.0);  // of no revolute body
  const JointDifference none = largest_difference(bodies, same);
  EXPECT_LT(none.angle, 1e-9);
  EXPECT_LT(none.distance, 1e-9);
  InsBodies other = bodies;
  other[1].point_in_child += 0.3 * other[1].child_R_axis.col(0);
  other[1].child_R_axis = other[1].child_R_axis * rot_x(0.2);
  const JointDifference some = largest_difference(bodies, other);
  EXPECT_NEAR(some.angle, 0.2, 1e-9);
  EXPECT_NEAR(some.distance, 0.3, 1e-9);
}

}  // namespace
}  // namespace kinfer
