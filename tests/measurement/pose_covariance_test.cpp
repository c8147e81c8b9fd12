// SPDX-License-Identifier: Apache-2.0
// Covariances of measured poses, directions of approach, and the edges of splits and merges.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/measurement/merge_pose_sets.hpp"
#include "kinfer/measurement/split.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

using test::random_vector;

Mat3 random_covariance(Rng& rng) {
  Mat3 root;
  for (int k = 0; k < 3; ++k) root.col(k) = random_vector(rng);
  return root * root.transpose();
}

TEST(PrincipalDeviations, MakeUpTheCovarianceAgain) {
  Rng rng(1);
  for (int k = 0; k < 20; ++k) {
    const Mat3 covariance = random_covariance(rng);
    const auto [sd, axes] = principal_deviations(covariance);
    EXPECT_LT((covariance_of(sd, axes) - covariance).norm(), 1e-13 * covariance.norm());
    EXPECT_LT((axes.transpose() * axes - Mat3::Identity()).norm(), 1e-13);
  }
}

TEST(PrincipalDeviations, NegativeVariancesAreZero) {
  const Mat3 rounded = Vec3(4.0, -1e-18, 1.0).asDiagonal();
  const Vec3 sd = principal_deviations(rounded).sd;
  EXPECT_NEAR(sd.maxCoeff(), 2.0, 1e-15);
  EXPECT_EQ(sd.minCoeff(), 0.0);
}

TEST(PrincipalDeviations, WithoutAxesTheDeviationsAreAlongTheWorld) {
  EXPECT_EQ(covariance_of(Vec3(1, 2, 3), std::nullopt), Mat3(Vec3(1, 4, 9).asDiagonal()));
}

TEST(Correlation, WhitensTheSixCoordinatesOfAPose) {
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  Rng rng(2);
  for (int k = 0; k < 10; ++k) {
    Mat6 root;
    for (double& number : root.reshaped()) number = rng.normal();
    const Mat6 covariance = root * root.transpose();
    const auto point = principal_deviations(covariance.topLeftCorner<3, 3>()),
               turn = principal_deviations(covariance.bottomRightCorner<3, 3>());
    OrientationMeasurement orientation;
    orientation.axes = turn.axes;
    orientation.covariance_with_point = covariance.topRightCorner<3, 3>();
    const Mat3 y = correlation(point.sd, point.axes, turn.sd, orientation);
    Mat6 whitening = Mat6::Zero();
    whitening.topLeftCorner<3, 3>() = point.sd.cwiseInverse().asDiagonal() * point.axes.transpose();
    whitening.bottomRightCorner<3, 3>() = turn.sd.cwiseInverse().asDiagonal() * turn.axes.transpose();
    Mat6 expected = Mat6::Identity();
    expected.topRightCorner<3, 3>() = y, expected.bottomLeftCorner<3, 3>() = y.transpose();
    EXPECT_LT((whitening * covariance * whitening.transpose() - expected).norm(), 1e-10);
    EXPECT_LT(svd(y).s[0], 1.0) << "of a positive definite covariance";
  }
}

TEST(Approach, IsTheSignOfTheLastMovement) {
  PoseSet set;
  set.joints = (MatrixXd(2, 5) << 0.0, 0.5, 0.5, 0.2, 0.2 + 4e-5,  //
                1.0, 1.0, 0.9, 1.5, 1.4)
                   .finished();
  const MatrixXd expected = (MatrixXd(2, 5) << 0, 1, 1, -1, -1,  //
                             0, 0, -1, 1, -1)
                                .finished();
  EXPECT_EQ(with_approach(set).approach, expected);
  set.joints *= 1e-3;  // in no unit
  EXPECT_EQ(with_approach(set).approach, expected);
  set.pose = {0, 1, 2, 3, 3};  // the last row repeats the pose: it has not moved
  EXPECT_EQ(with_approach(set).approach.col(4), expected.col(3));
  set.joints.resize(2, 0);
  EXPECT_EQ(with_approach(set).approach.size(), 0);
}

TEST(Approach, OfSlowMovementsIsTheirSenseAndScatterHasNone) {
  PoseSet set;
  set.joints = MatrixXd::Zero(1, 2001);
  for (int i = 1; i <= 2000; ++i) set.joints(0, i) = i <= 1000 ? 5e-5 * i : 5e-2 - 5e-5 * (i - 1000);
  set.joints(0, 500) -= 2e-6, set.joints(0, 501) -= 5.2e-5;
  const MatrixXd approach = with_approach(set).approach;
  for (int i = 1; i <= 2000; ++i) EXPECT_EQ(approach(0, i), i <= 1000 ? 1.0 : -1.0) << i;
}

TEST(HasMeasurements, IsTrueForOneOfAnyKind) {
  EXPECT_FALSE(has_measurements({}));
  std::vector<PoseSet> sets(7);
  sets[0].points.emplace_back(), sets[1].orientations.emplace_back(), sets[2].distances.emplace_back();
  sets[3].contacts.emplace_back(), sets[4].pairs.emplace_back(), sets[5].plane_contacts.emplace_back();
  sets[6].tilts.emplace_back();
  for (const PoseSet& set : sets) EXPECT_TRUE(has_measurements(set));
}

/// One row in a set-up of this name.
PoseSet one_row(const std::string& setup, double joint) {
  PoseSet set;
  set.joint_names = {"J1"};
  set.joints = MatrixXd::Constant(1, 1, joint);
  set.points = {{.row = 0, .target = -1, .position = Vec3::Zero(), .sd = {}}};
  if (!setup.empty()) set.setups = {setup}, set.setup = {0};
  return set;
}

TEST(Merge, SetupsOfTheSameNameAreOneAndARowWithoutOneHasNone) {
  const PoseSet same = merge_pose_sets(one_row("A", 1), one_row("A", 2));
  EXPECT_EQ(same.setups, std::vector<std::string>{"A"});
  EXPECT_EQ(same.setup, (std::vector<int>{0, 0}));
  const PoseSet other = merge_pose_sets(one_row("A", 1), one_row("B", 2));
  EXPECT_EQ(other.setups, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(other.setup, (std::vector<int>{0, 1}));
  EXPECT_EQ(merge_pose_sets(one_row("", 1), one_row("B", 2)).setup, (std::vector<int>{-1, 0}));
  EXPECT_EQ(merge_pose_sets(one_row("A", 1), one_row("", 2)).setup, (std::vector<int>{0, -1}));
  EXPECT_TRUE(merge_pose_sets(one_row("", 1), one_row("", 2)).setup.empty());
}

TEST(Merge, ColumnsThatOnlyOneSetHasAreUnknownInTheOther) {
  PoseSet loaded = one_row("", 1), bare = one_row("", 2);
  loaded.payload = {5.0}, loaded.temperature = {30.0}, loaded.torques = MatrixXd::Constant(1, 1, 8.0);
  const PoseSet after = merge_pose_sets(bare, loaded), before = merge_pose_sets(loaded, bare);
  EXPECT_EQ(after.payload, (std::vector<double>{0.0, 5.0}));
  EXPECT_EQ(before.payload, (std::vector<double>{5.0, 0.0}));
  EXPECT_TRUE(std::isnan(after.temperature[0]) && std::isnan(before.temperature[1]));
  EXPECT_TRUE(std::isnan(after.torques(0, 0)) && std::isnan(before.torques(0, 1)));
  EXPECT_EQ(after.torques(0, 1), 8.0);
  PoseSet other_robot = bare;
  other_robot.joints = MatrixXd::Zero(2, 1);
  EXPECT_DEATH(merge_pose_sets(bare, other_robot), "");
}

TEST(SplitEdges, NoRowAndOneRowAreFittedOrHeldOutAsTheFractionSays) {
  EXPECT_TRUE(random_split(0, 0.5, Rng(1)).train.empty() && random_split(0, 0.5, Rng(1)).holdout.empty());
  EXPECT_EQ(random_split(1, 0.2, Rng(1)).train, std::vector<int>{0});
  EXPECT_EQ(random_split(1, 0.9, Rng(1)).holdout, std::vector<int>{0});
  EXPECT_DEATH(random_split(5, 1.5, Rng(1)), "fraction 1.5");
  EXPECT_DEATH(folds(3, 4, Rng(1)), "4 folds of 3 rows");
}

TEST(SplitEdges, TheSameSeedSplitsTheSameWayAndFoldsDifferByOneRowAtMost) {
  EXPECT_EQ(random_split(50, 0.3, Rng(7)).holdout, random_split(50, 0.3, Rng(7)).holdout);
  EXPECT_NE(random_split(50, 0.3, Rng(7)).holdout, random_split(50, 0.3, Rng(8)).holdout);
  std::size_t least = 100, most = 0;
  for (const Split& split : folds(17, 5, Rng(1))) {
    least = std::min(least, split.holdout.size()), most = std::max(most, split.holdout.size());
    EXPECT_TRUE(std::is_sorted(split.train.begin(), split.train.end()));
  }
  EXPECT_LE(most - least, 1u);
}

}  // namespace
}  // namespace kinfer
