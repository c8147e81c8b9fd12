// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/iso9283.hpp"

#include <gtest/gtest.h>

#include "kinfer/kinematics/forward.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

Chain arm() {
  Chain chain = test::with_table3_errors(test::er20());
  chain.tool.xyz = {0.03, -0.02, 0.1};
  return chain;
}

TEST(Iso9283, AccuracyAndRepeatabilityAreThoseOfTheStandard) {
  const Chain chain = arm();
  PoseSet data = test::measured(chain, test::paper2_poses(3, test::noise_free), 1);
  data.joints.col(1) = data.joints.col(0);
  const Vec3 p = forward(chain, data.joints.col(0)).position;
  data.points[0].position = p + Vec3(3e-3, 1e-3, 0);
  data.points[1].position = p + Vec3(3e-3, -1e-3, 0);
  const std::vector<PoseAccuracy> poses = evaluate_pose_accuracy(chain, chain, data);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].rows, (std::vector<int>{0, 1}));
  EXPECT_NEAR(poses[0].accuracy_after, 3e-3, 1e-12);
  EXPECT_NEAR(*poses[0].repeatability, 1e-3, 1e-12);  // both lie 1 mm from the mean: that distance does not scatter
  EXPECT_FALSE(poses[1].repeatability.has_value());
}

TEST(Iso9283, ACopyOfAMeasurementIsNoRepetition) {
  const Chain chain = arm();
  PoseSet data = test::measured(chain, test::paper2_poses(3, test::noise_free), 1);
  data.joints.col(1) = data.joints.col(0);
  data.points[1].position = data.points[0].position;
  const std::vector<PoseAccuracy> poses = evaluate_pose_accuracy(chain, chain, data);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].rows, (std::vector<int>{0, 1}));
  EXPECT_FALSE(poses[0].repeatability.has_value());
}

TEST(Iso9283, AnotherLoadTemperatureOrSetUpIsAnotherPose) {
  Chain chain = arm();
  chain.mountings = {{.name = "second", .base = Frame{.xyz = Vec3(1.0, 0.0, 0.0)}, .tool = chain.tool}};
  PoseSet data = test::measured(chain, test::paper2_poses(5, test::noise_free), 1);
  for (int row = 1; row < 5; ++row) data.joints.col(row) = data.joints.col(0);
  data.payload = {0.0, 0.0, 20.0, 0.0, 0.0};
  data.temperature = {20.0, 20.0, 20.0, 35.0, 20.0};
  data.mounting = {-1, -1, -1, -1, 0};
  const Vec3 p = forward(chain, data.joints.col(0)).position;
  const double off[] = {-1e-3, 1e-3, 2e-3, 3e-3, 4e-3};
  for (int row = 0; row < 5; ++row) data.points[row].position = p + Vec3(row == 4 ? 1.0 : 0.0, 0.0, off[row]);
  const std::vector<PoseAccuracy> poses = evaluate_pose_accuracy(chain, chain, data);
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_EQ(poses[0].rows, (std::vector<int>{0, 1}));
  EXPECT_NEAR(*poses[0].repeatability, 1e-3, 1e-12);
  for (int k = 1; k < 4; ++k) {
    EXPECT_EQ(poses[k].rows, std::vector<int>{k + 1});
    EXPECT_NEAR(poses[k].accuracy_after, off[k + 1], 1e-12);
    EXPECT_FALSE(poses[k].repeatability.has_value());
  }
}

TEST(Iso9283, RowsOfOnePoseAreThoseOfOneCommandHoweverReadingsScatter) {
  const Chain chain = arm();
  PoseSet data = test::measured(chain, test::paper2_poses(400, test::noise_free), 1);
  Rng rng(7);
  const double scatter = 1e-4, apart = 0.1;  // [rad]
  for (Eigen::Index row = 0; row < data.joints.cols(); ++row)
    for (Eigen::Index k = 0; k < data.joints.rows(); ++k) {
      const double step = std::floor(rng.uniform(-1.0, 1.0));
      data.joints(k, row) = apart * step + scatter * rng.uniform(-1.0, 1.0);
    }
  std::vector<std::vector<int>> expected;
  for (int row = 0; row < data.rows(); ++row) {
    const auto known = std::ranges::find_if(expected, [&](const std::vector<int>& rows) {
      return (data.joints.col(rows.front()) - data.joints.col(row)).cwiseAbs().maxCoeff() < 0.5 * apart;
    });
    if (known == expected.end())
      expected.push_back({row});
    else
      known->push_back(row);
  }
  ASSERT_EQ(expected.size(), 64u);
  const std::vector<PoseAccuracy> poses = evaluate_pose_accuracy(chain, chain, data);
  ASSERT_EQ(poses.size(), expected.size());
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(poses[i].rows, expected[i]);
}

}  // namespace
}  // namespace kinfer
