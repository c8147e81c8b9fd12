// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/compare.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/validation/iso9283.hpp"
#include "kinfer/io/evidence/joint_tables_csv.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
using namespace deploy;
namespace {

Chain arm() {
  Chain chain = test::with_table3_errors(test::er20());
  chain.tool.xyz = {0.03, -0.02, 0.1};
  return chain;
}

CalibratedRobot calibrated(const Chain& truth, int seed) {
  const CalibrationTask task{.nominal = test::er20(),
                             .tolerances = {},
                             .instrument = test::tracker,
                             .data = test::measured(truth, test::paper2_poses(50, test::tracker), seed)};
  const Estimate estimate = fit_once(task, task.data, GeometricParameters{}, {}).value();
  CalibratedRobot robot{with_small_rotations_folded(estimate.chain), {}};
  for (const ParameterEstimate& p : estimate.values) robot.sd[p.name] = p.sd;
  return robot;
}

TEST(Compare, TwoCalibrationsOfOneRobotDifferByChanceOnly) {
  const CalibratedRobot first = calibrated(arm(), 1);
  int alarms = 0;
  for (int seed = 2; seed < 12; ++seed) alarms += compare_calibrations(first, calibrated(arm(), seed)).value().changed;
  EXPECT_EQ(alarms, 0);
}

TEST(Compare, ASlippedEncoderIsListedFirst) {
  Chain knocked = arm();
  std::get<MdhLink>(knocked.joints[2].link).theta += 0.02 * degree;
  const CalibrationComparison changes = compare_calibrations(calibrated(arm(), 1), calibrated(knocked, 2)).value();
  EXPECT_TRUE(changes.changed);
  EXPECT_EQ(changes.parameters.front().name, "theta3");
  EXPECT_NEAR(changes.parameters.front().change, 0.02 * degree, 5 * changes.parameters.front().sd);
  EXPECT_GT(changes.tool_worst, 1e-4);
}

TEST(Compare, RobotsOfDifferentTypesAreRefused) {
  Chain other = arm();
  other.joints.pop_back();
  EXPECT_FALSE(compare_calibrations({arm(), {{"a2", 1e-5}}}, {other, {{"a2", 1e-5}}}).has_value());
  EXPECT_FALSE(compare_calibrations({arm(), {}}, {arm(), {}}).has_value());
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

TEST(JointTables, CalibratedRowsStayNearTheNominalOnesWithParallelAxes) {
  const CalibratedRobot robot = calibrated(arm(), 1);
  const Chain nominal = test::er20();
  for (std::size_t j = 0; j < 6; ++j) {
    const auto &a = std::get<MdhLink>(nominal.joints[j].link), &b = std::get<MdhLink>(robot.chain.joints[j].link);
    EXPECT_NEAR(a.a, b.a, 2e-3);
    EXPECT_NEAR(a.d, b.d, 2e-3);
    EXPECT_NEAR(a.theta, b.theta, 0.5 * degree);
    EXPECT_NEAR(a.alpha, b.alpha, 0.5 * degree);
    EXPECT_NEAR(b.beta, 0.0, 0.5 * degree);
  }
}

TEST(JointTables, EncoderOffsetsAreSeparatedFromGeometry) {
  const CalibrationTask task{.nominal = test::er20(),
                             .tolerances = {},
                             .instrument = test::tracker,
                             .data = test::measured(arm(), test::paper2_poses(50, test::tracker), 1)};
  const std::string csv =
      format_encoder_offsets_csv(task.nominal, fit_once(task, task.data, GeometricParameters{}, {}).value());
  EXPECT_EQ(csv.find("joint,offset,sd,unit,identifiable\nJ1,"), 0u);
  const std::size_t j3 = csv.find("J3,");
  EXPECT_NEAR(std::stod(csv.substr(j3 + 3)), 0.003, 2e-3) << csv;  // degrees, table 3
}

}  // namespace
}  // namespace kinfer
