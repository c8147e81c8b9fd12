// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/geometry/joint_precision.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "identify/measured_segments.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/random.hpp"
#include "kinfer/identify/programming/structure_fit.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::general_hinge;

struct NoisyJoint {
  std::vector<FrameState> parent = test::freely_moving();
  JointSignal angle = test::wave(0.6, 0.9, 1.0);
  std::vector<FrameState> child = propagate(parent, general_hinge(), {&angle, 1});
  JointGeometry truth =
      fit_revolute_geometry(general_hinge(), {{{-0.6}, {0}, {0}}, {{0.1}, {0}, {0}}, {{0.9}, {0}, {0}}});

  /// White noise on the child's accelerations [m/s²] and orientations [rad].
  NoisyJoint with_noise(double acceleration, double rotation, std::uint64_t seed) const {
    NoisyJoint noisy = *this;
    Rng rng(seed);
    const auto draw = [&](double sd) { return Vec3(sd * normal_vector(rng)); };
    for (FrameState& s : noisy.child) {
      s.acceleration += draw(acceleration);
      s.rotation = exp_so3(draw(rotation)) * s.rotation;
    }
    return noisy;
  }
  JointPrecision precision(const std::vector<std::size_t>& rows = test::all_rows(600)) const {
    return revolute_precision(truth, parent, child, angle, rows);
  }
};

double largest_axis_sd(const JointPrecision& precision) {
  return std::max(precision.sd.axis_in_parent[0], precision.sd.axis_in_parent[1]);
}

double largest_point_sd(const JointPrecision& precision) {
  return std::max(precision.sd.point_in_child[0], precision.sd.point_in_child[1]);
}

TEST(JointPrecision, IsProportionalToTheNoise) {
  const JointPrecision one = NoisyJoint().with_noise(0.02, 1e-3, 1).precision(),
                       ten = NoisyJoint().with_noise(0.2, 1e-2, 1).precision();
  EXPECT_NEAR(largest_axis_sd(ten) / largest_axis_sd(one), 10.0, 0.1);
  EXPECT_NEAR(largest_point_sd(ten) / largest_point_sd(one), 10.0, 0.1);
  EXPECT_NEAR(ten.sd.along_axis / one.sd.along_axis, 10.0, 0.1);
}

TEST(JointPrecision, ImprovesWithTheRootOfTheNumberOfRows) {
  const NoisyJoint noisy = NoisyJoint().with_noise(0.02, 1e-3, 2);
  std::vector<std::size_t> sixth;
  for (std::size_t row = 0; row < 600; row += 6) sixth.push_back(row);
  const double ratio = largest_axis_sd(noisy.precision(sixth)) / largest_axis_sd(noisy.precision());
  EXPECT_NEAR(ratio, std::sqrt(6.0), 0.4);
}

TEST(JointPrecision, IsTheScatterOfFittedJoints) {
  // The search weighs accelerations and rotations alike, so it reaches the bound where both are as noisy.
  constexpr int fits = 40;
  const NoisyJoint exact;
  const JointPrecision stated = exact.with_noise(0.01, 0.01, 99).precision();
  double axis_square = 0.0, point_square = 0.0;
  for (std::uint64_t seed = 0; seed < fits; ++seed) {
    const NoisyJoint noisy = exact.with_noise(0.01, 0.01, seed);
    const StructureFit fit = StructureFitter(noisy.parent, noisy.child, {&noisy.angle, 1}, test::all_rows(600),
                                             {.length_prior = 1e-6, .bias_prior = 1e3})
                                 .fit(revolute_structure());
    const JointGeometry found =
        fit_revolute_geometry(fit.leaves, {{{-0.6}, {0}, {0}}, {{0.1}, {0}, {0}}, {{0.9}, {0}, {0}}});
    axis_square += found.axis_in_parent.cross(exact.truth.axis_in_parent).squaredNorm() / fits;
    point_square +=
        (found.point_in_child - exact.truth.point_in_child).cross(exact.truth.axis_in_child).squaredNorm() / fits;
  }
  const double axis_sd = std::hypot(stated.sd.axis_in_parent[0], stated.sd.axis_in_parent[1]),
               point_sd = std::hypot(stated.sd.point_in_child[0], stated.sd.point_in_child[1]);
  EXPECT_NEAR(std::sqrt(axis_square) / axis_sd, 1.0, 0.4);
  EXPECT_NEAR(std::sqrt(point_square) / point_sd, 1.0, 0.4);
}

TEST(JointPrecision, AFreelyMovingJointIsWhollyObservable) {
  const JointPrecision precision = NoisyJoint().with_noise(0.02, 1e-3, 3).precision();
  EXPECT_TRUE(precision.unobservable_in_parent.empty());
  EXPECT_TRUE(precision.unobservable_in_child.empty());
  ASSERT_EQ(precision.canonical_sd.size(), 3U);
  for (const DhNumbers& row : precision.canonical_sd) {
    EXPECT_LT(row.alpha, 0.01);
    EXPECT_LT(row.a, 0.1);
  }
}

TEST(JointPrecision, OnABaseAtRestOnlyTheChildsLeverAcrossTheAxisIsObservable) {
  NoisyJoint joint;
  joint.parent = test::at_rest();
  joint.child = propagate(joint.parent, general_hinge(), {&joint.angle, 1});
  const JointPrecision precision = joint.with_noise(0.02, 1e-5, 4).precision();
  EXPECT_EQ(precision.unobservable_in_parent.size(), 3U);
  ASSERT_EQ(precision.unobservable_in_child.size(), 1U);
  EXPECT_GT(std::abs(precision.unobservable_in_child[0].dot(joint.truth.axis_in_child)), 0.999);
  EXPECT_LT(largest_point_sd(precision), 0.05);
  EXPECT_GT(precision.sd.point_in_parent[0], 10.0) << "the prior alone";
}

TEST(JointPrecision, CorrelatedErrorsCountForFewerSamples) {
  NoisyJoint white = NoisyJoint().with_noise(0.05, 1e-3, 5), slow;
  Rng rng(5);
  Vec3 error = Vec3::Zero();
  for (FrameState& s : slow.child) {  // the same variance, with a memory of ten rows
    error = 0.9 * error + std::sqrt(1.0 - 0.81) * 0.05 * normal_vector(rng);
    s.acceleration += error;
    s.rotation = exp_so3(1e-3 * normal_vector(rng)) * s.rotation;
  }
  EXPECT_GT(largest_point_sd(slow.precision()), 2.0 * largest_point_sd(white.precision()));
}

}  // namespace
}  // namespace kinfer
