// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/magnetic_faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

TEST(MagneticFaults, HardIronHasTheStatedSizeAndMovesWithTheSensor) {
  const std::vector<Vec3> field{Vec3(20, 0, -44), Vec3(0, 20, -44)};
  const auto measured = with_iron(field, 4.0, 0.0, Rng(3));
  EXPECT_NEAR((measured[0] - field[0]).norm(), 4.0, 1e-9);
  EXPECT_LT(((measured[0] - field[0]) - (measured[1] - field[1])).norm(), 1e-9);
}

TEST(MagneticFaults, SoftIronIsSymmetric) {
  const std::vector<Vec3> axes{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const auto measured = with_iron(axes, 0.0, 0.1, Rng(5));
  Mat3 matrix;
  for (int i = 0; i < 3; ++i) matrix.col(i) = measured[static_cast<std::size_t>(i)];
  EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12);
  EXPECT_GT((matrix - Mat3::Identity()).norm(), 0.05);
}

TEST(MagneticFaults, ASoundMagnetometerIsNotChanged) {
  const std::vector<Vec3> field{Vec3(20, 0, -44)};
  EXPECT_EQ(with_iron(field, 0.0, 0.0, Rng(7)), field);
}

TEST(MagneticFaults, TransientsReachTheirPeakAndLeaveMostOfTheLogAlone) {
  const std::vector<Vec3> field(6000, Vec3::Zero());
  const auto disturbed = with_transients(field, 10.0, 0.01, Rng(11));
  double largest = 0.0;
  for (const Vec3& f : disturbed) largest = std::max(largest, f.norm());
  EXPECT_GT(largest, 9.9);
  EXPECT_LT(largest, 30.0) << "a few may overlap";
  EXPECT_GT(std::ranges::count(disturbed, Vec3(Vec3::Zero())), 2000);
}

}  // namespace
}  // namespace kinfer
