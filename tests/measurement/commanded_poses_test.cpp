// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/commanded_poses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/rng.hpp"

namespace kinfer {
namespace {

MatrixXd uniform(int joints, int rows, std::uint64_t seed, double range = 4.0) {
  Rng rng(seed);
  MatrixXd q(joints, rows);
  for (double& value : q.reshaped()) value = range * rng.uniform();
  return q;
}

/// Each column `times` times in a row, its readings off by normal numbers of this size.
MatrixXd repeated(const MatrixXd& poses, int times, double scatter, std::uint64_t seed) {
  Rng rng(seed);
  MatrixXd q(poses.rows(), poses.cols() * times);
  for (Eigen::Index k = 0; k < q.cols(); ++k)
    for (Eigen::Index j = 0; j < q.rows(); ++j) q(j, k) = poses(j, k / times) + scatter * rng.normal();
  return q;
}

std::vector<int> poses_of(const MatrixXd& joints) {
  const double range = (joints.rowwise().maxCoeff() - joints.rowwise().minCoeff()).maxCoeff();
  return commanded_poses(joints, VectorXd::Constant(joints.rows(), range));
}

int count(const std::vector<int>& poses) {
  return 1 + *std::ranges::max_element(poses);
}

TEST(CommandedPoses, RepeatsAreFoundHoweverMuchTheReadingsScatter) {
  for (const double scatter : {0.0, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const std::vector<int> poses = poses_of(repeated(uniform(6, 12, seed), 20, scatter, seed));
      for (std::size_t row = 0; row < poses.size(); ++row)
        ASSERT_EQ(poses[row], static_cast<int>(row / 20)) << scatter << " rad, seed " << seed;
    }
}

TEST(CommandedPoses, RepeatsThatDoNotFollowOneAnotherAreFound) {
  const MatrixXd poses = uniform(6, 10, 1), once = repeated(poses, 1, 1e-4, 2), again = repeated(poses, 1, 1e-4, 3);
  MatrixXd q(6, 20);
  q << once, again;
  const std::vector<int> found = poses_of(q);
  for (int row = 0; row < 20; ++row) EXPECT_EQ(found[static_cast<std::size_t>(row)], row % 10);
}

TEST(CommandedPoses, OneHomePoseAmongManyOthersIsFound) {
  MatrixXd q(6, 44);
  q << uniform(6, 40, 1), repeated(uniform(6, 1, 2), 4, 1e-4, 3);
  EXPECT_EQ(count(poses_of(q)), 41);
}

TEST(CommandedPoses, NoUnitIsLargeOrSmall) {
  for (const double size : {1e-7, 1e-4, 1.0, 1e3, 1e6}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
      EXPECT_EQ(count(poses_of(uniform(1, 30, seed, size))), 30) << "range " << size << ", seed " << seed;
    EXPECT_EQ(count(poses_of(repeated(uniform(3, 12, 1, size), 5, 1e-5 * size, 2))), 12) << "range " << size;
  }
}

TEST(CommandedPoses, DensePosesAtRandomAreDifferent) {
  for (const int joints : {1, 2, 3, 6})
    for (const int rows : {5, 30, 300, 1500})
      for (std::uint64_t seed = 1; seed <= 5; ++seed)
        EXPECT_EQ(count(poses_of(uniform(joints, rows, seed))), rows) << joints << " joints, seed " << seed;
}

TEST(CommandedPoses, PosesOfOneDenseRegionBesideManyFarApartAreDifferent) {
  MatrixXd q(3, 300);
  q << uniform(3, 150, 1), 0.1 * uniform(3, 150, 2);
  EXPECT_EQ(count(poses_of(q)), 300);
}

TEST(CommandedPoses, PosesOnAPathOrAGridAreDifferent) {
  MatrixXd path(3, 2000), grid(3, 1000), swing(1, 500);
  for (int k = 0; k < 2000; ++k) path.col(k) << std::sin(1e-3 * k), std::cos(2e-3 * k), 1e-3 * k;
  for (int k = 0; k < 1000; ++k) grid.col(k) << k % 10, 0.2 * (k / 10 % 10), k / 100;
  for (int k = 0; k < 500; ++k) swing(0, k) = std::sin(0.0388 * k);  // slow at both ends
  EXPECT_EQ(count(poses_of(path)), 2000);
  EXPECT_EQ(count(poses_of(grid)), 1000);
  EXPECT_EQ(count(poses_of(swing)), 500);
}

TEST(CommandedPoses, RowsThatAreAllTheSameAreOnePose) {
  EXPECT_EQ(count(poses_of(repeated(uniform(6, 1, 1), 50, 0.0, 2))), 1);
}

TEST(CommandedPoses, RowsFarNearerToEachOtherThanTheirUnitAreOnePose) {
  const MatrixXd scattered = repeated(uniform(6, 1, 1), 50, 1e-5, 2);
  EXPECT_EQ(count(commanded_poses(scattered, VectorXd::Constant(6, 1e-3))), 1);
  EXPECT_EQ(count(poses_of(scattered)), 50);
}

TEST(CommandedPoses, HundredThousandRowsTakeLessThanSeconds) {
  EXPECT_EQ(count(poses_of(repeated(uniform(6, 5000, 1), 20, 1e-6, 2))), 5000);
}

}  // namespace
}  // namespace kinfer
