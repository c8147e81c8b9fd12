// SPDX-License-Identifier: Apache-2.0
// Lengths of real machines with mounts that give way, and with vibration: inside their intervals. Test 1 of the
// pendulum set considered_over_persistent; the others are kept apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "kinfer/identify/pipeline.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "repeats.hpp"

namespace kinfer {
using namespace identify;
namespace {

Identification found_in(const std::string& file, const char* root) {
  const auto found = identify_machine(read_ins_csv(file).value(), {.root = root}, Rng(1));
  EXPECT_TRUE(found) << (found ? "" : found.error().what);
  return found ? *found : Identification{};
}

TEST(MeasuredLengths, OfAPendulumAreInsideTheirIntervals) {
  const char* data = std::getenv("KINFER_DATA");
  if (!data) GTEST_SKIP() << "KINFER_DATA is not set";
  constexpr double hinge_to_hinge = 0.519;  // [m] by optical markers, both segments
  for (const char* test : test::repeats({"test1", "test2", "test3"})) {
    const Identification found = found_in(std::string(data) + "/pendulum_ins/" + test + ".csv", "S3");
    ASSERT_EQ(found.links.size(), 2u) << test;
    for (const LinkEstimate& link : found.links) {
      ASSERT_TRUE(link.pin) << test << link.segment;
      EXPECT_NEAR(link.pin->distance, hinge_to_hinge, 2.0 * link.pin->sd) << test << link.segment;
      EXPECT_LT(link.pin->sd, 0.025) << test << link.segment;
    }
  }
}

/// Position along a line of its point nearest to another one.
double foot(const Vec3& axis, const Vec3& point, const Vec3& other_axis, const Vec3& other_point) {
  const double cosine = axis.dot(other_axis);
  const Vec3 between = other_point - point;
  return (between.dot(axis) - cosine * between.dot(other_axis)) / (1.0 - cosine * cosine);
}

TEST(MeasuredLengths, OfASlowArmThatVibratesAreInsideTheirIntervals) {
  const char* data = std::getenv("KINFER_DATA");
  if (!data) GTEST_SKIP() << "KINFER_DATA is not set";
  for (const char* trial : test::repeats({"trial1", "trial3"})) {
    const Identification found = found_in(std::string(data) + "/kuka_iiwa_ins/" + trial + "_imu.csv", "D");
    ASSERT_EQ(found.joints.size(), 5u) << trial;  // joints 2 to 6, parents first
    for (const std::size_t middle : {1u, 3u}) {
      const JointEstimate &in = found.joints[middle - 1], &along = found.joints[middle],
                          &out = found.joints[middle + 1];
      const double begin = foot(along.axis_in_parent, along.point_in_parent, in.axis_in_child, in.point_in_child),
                   end = foot(along.axis_in_child, along.point_in_child, out.axis_in_parent, out.point_in_parent);
      const double sd = std::hypot(std::max(in.sd.point_in_child[0], in.sd.point_in_child[1]), along.sd.along_axis,
                                   std::max(out.sd.point_in_parent[0], out.sd.point_in_parent[1]));
      EXPECT_NEAR(std::abs(end - begin), 0.4, 2.0 * sd) << trial << " joint " << middle + 2;
      EXPECT_NEAR(std::abs(end - begin), 0.4, 0.05) << trial << " joint " << middle + 2;
    }
  }
}

}  // namespace
}  // namespace kinfer
