// SPDX-License-Identifier: Apache-2.0
// Tables of calibrated robots: DH rows near the nominal ones, encoder offsets apart from geometry.
#include <gtest/gtest.h>

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/io/evidence/files/joint_tables_csv.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

Chain measured_arm() {
  Chain chain = test::with_table3_errors(test::er20());
  chain.tool.xyz = {0.03, -0.02, 0.1};
  return chain;
}

CalibrationTask measured_task() {
  return {.nominal = test::er20(),
          .instrument = test::tracker,
          .data = test::measured(measured_arm(), test::paper2_poses(50, test::tracker), 1)};
}

Estimate fitted(const CalibrationTask& task) {
  return fit_once(task, task.data, GeometricParameters{}, {}).value();
}

TEST(CalibrationTables, CalibratedRowsStayNearTheNominalOnesWithParallelAxes) {
  const Chain found = with_small_rotations_folded(fitted(measured_task()).chain);
  const Chain nominal = test::er20();
  for (std::size_t j = 0; j < 6; ++j) {
    const auto &a = std::get<MdhLink>(nominal.joints[j].link), &b = std::get<MdhLink>(found.joints[j].link);
    EXPECT_NEAR(a.a, b.a, 2e-3);
    EXPECT_NEAR(a.d, b.d, 2e-3);
    EXPECT_NEAR(a.theta, b.theta, 0.5 * degree);
    EXPECT_NEAR(a.alpha, b.alpha, 0.5 * degree);
    EXPECT_NEAR(b.beta, 0.0, 0.5 * degree);
  }
}

TEST(CalibrationTables, EncoderOffsetsAreReportedApartFromGeometry) {
  const CalibrationTask task = measured_task();
  const std::string csv = format_encoder_offsets_csv(task.nominal, fitted(task));
  EXPECT_EQ(csv.find("joint,offset,sd,unit,identifiable\nJ1,"), 0u);
  const std::size_t j3 = csv.find("J3,");
  EXPECT_NEAR(std::stod(csv.substr(j3 + 3)), 0.003, 2e-3) << csv;  // degrees, table 3
}

}  // namespace
}  // namespace kinfer
