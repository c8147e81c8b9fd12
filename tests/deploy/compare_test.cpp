// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/compare.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
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

}  // namespace
}  // namespace kinfer
