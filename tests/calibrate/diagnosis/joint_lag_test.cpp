// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/joint_lag.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinfer/calibrate/diagnosis/diagnose.hpp"
#include "kinfer/words/findings/findings.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using Eigen::Index;

constexpr int lag_rows = 60;

/// A six-axis arm with errors of its tolerances, measured at rest by a tracker.
CalibrationTask settled_robot(int seed, int rows = lag_rows, double gear = 0.0) {
  Chain nominal = test::er20();
  nominal.tool.xyz = {0.03, -0.02, 0.1};
  Chain truth = with_random_errors(nominal, {}, Rng(seed));
  for (Joint& joint : truth.joints) joint.harmonics = {{1.0, gear, 0.0}, {2.0, 0.0, gear}};
  return {.nominal = nominal,
          .tolerances = {},
          .instrument = test::tracker,
          .data = simulate_pose_set(
                      truth, {.poses = rows, .space = {}, .instrument = test::tracker, .measured = Measured::positions},
                      Rng(seed).stream(9))
                      .value()};
}

/// Joint positions at which a part of the motion to another row was made; the part decays over the rows.
MatrixXd read_on_the_way(const MatrixXd& at_rest, Index other, double part) {
  MatrixXd read = at_rest;
  for (Index row = 0; row < at_rest.cols(); ++row)
    if (row + other >= 0 && row + other < at_rest.cols()) {
      const double decayed = part * (1.5 - static_cast<double>(row) / static_cast<double>(at_rest.cols()));
      read.col(row) += decayed * (at_rest.col(row + other) - at_rest.col(row));
    }
  return read;
}

std::optional<Finding> finding_of(const Diagnosis& diagnosis, FindingKind kind) {
  for (const Finding& finding : diagnosis.findings)
    if (finding.kind == kind) return finding;
  return std::nullopt;
}

TEST(JointLag, CommandedPositionsReplaceThoseReadBeforeTheArmHadSettledAndTheLagIsStated) {
  for (int seed = 1; seed <= 5; ++seed) {
    CalibrationTask task = settled_robot(seed);
    task.data.commanded = task.data.joints;
    task.data.joints = read_on_the_way(task.data.joints, -1, 1e-3);
    const Diagnosis diagnosis = diagnose(task);
    const auto finding = finding_of(diagnosis, FindingKind::not_settled);
    ASSERT_TRUE(finding) << seed;
    EXPECT_TRUE(finding->applied);
    EXPECT_EQ(diagnosis.corrected_task.data.joints, task.data.commanded);
    EXPECT_NEAR(finding->values.number("lag"), 1.0, 5.0 * finding->values.number("lag_sd")) << seed;
    EXPECT_LT(finding->values.number("lag_sd"), 0.1);
    EXPECT_FALSE(finding_of(diagnosis, FindingKind::joint_lag)) << words::sentence(*finding);
  }
}

TEST(JointLag, OneRowInFourReadTooEarlyIsEnough) {
  CalibrationTask task = settled_robot(3, 80);
  task.data.commanded = task.data.joints;
  const MatrixXd early = read_on_the_way(task.data.joints, -1, 2e-3);
  for (Index row = 0; row < 80; row += 4) task.data.joints.col(row) = early.col(row);
  const auto finding = finding_of(diagnose(task), FindingKind::not_settled);
  ASSERT_TRUE(finding);
  EXPECT_TRUE(finding->applied) << "the median errors of both fits are alike";
}

/// A slide that read-back and command differ on by a millimetre is no angle of a milliradian.
TEST(JointLag, APrismaticJointDiffersInMetres) {
  Chain nominal = test::er20();
  nominal.joints[0].type = JointType::prismatic;
  CalibrationTask task = settled_robot(2);
  task.nominal = nominal;
  task.data.points.clear();
  task.data.commanded = task.data.joints;
  task.data.joints.row(0).array() += 0.7e-3;
  const auto finding = finding_of(diagnose(task), FindingKind::not_settled);
  ASSERT_TRUE(finding);
  EXPECT_NEAR(finding->values.number("difference_m"), 0.7e-3, 1e-12);
  EXPECT_NEAR(finding->values.number("difference_rad"), 0.0, 1e-12);
  EXPECT_NE(words::sentence(*finding).find("differ by 0.000 deg and 0.700 mm typically"), std::string::npos)
      << words::sentence(*finding);
  task.data.joints.row(0) = task.data.commanded.row(0).array() + 0.4e-3;
  EXPECT_FALSE(finding_of(diagnose(task), FindingKind::not_settled));
}

TEST(JointLag, RowsWithoutACommandKeepTheirMeasuredPositions) {
  CalibrationTask task = settled_robot(2);
  task.data.commanded = task.data.joints;
  task.data.joints = read_on_the_way(task.data.joints, -1, 1e-3);
  task.data.commanded.col(5).setConstant(std::numeric_limits<double>::quiet_NaN());
  const Diagnosis diagnosis = diagnose(task);
  ASSERT_TRUE(finding_of(diagnosis, FindingKind::not_settled));
  EXPECT_EQ(diagnosis.corrected_task.data.joints.col(5), task.data.joints.col(5));
  EXPECT_EQ(diagnosis.corrected_task.data.joints.col(6), task.data.commanded.col(6));
}

TEST(JointLag, WithoutCommandsTheLastMotionIsNamedAndItsPart) {
  for (int seed = 1; seed <= 5; ++seed) {
    CalibrationTask task = settled_robot(seed);
    task.data.joints = read_on_the_way(task.data.joints, -1, 1e-3);
    const auto finding = finding_of(diagnose(task), FindingKind::joint_lag);
    ASSERT_TRUE(finding) << seed;
    EXPECT_EQ(finding->values.text("motion"), "last");
    EXPECT_NEAR(finding->values.number("lag"), 1e-3, 4e-4) << seed;
    EXPECT_FALSE(finding->applied);
  }
}

TEST(JointLag, JointsReadAfterTheArmHadMovedOnPointAlongTheNextMotion) {
  CalibrationTask task = settled_robot(1);
  task.data.joints = read_on_the_way(task.data.joints, 1, 1e-3);
  const auto finding = finding_of(diagnose(task), FindingKind::joint_lag);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->values.text("motion"), "next");
  EXPECT_LT(finding->values.number("lag"), 0.0) << "the points lie behind the joints";
}

TEST(JointLag, IsNotSeenWhereTheArmWasAtRest) {
  for (int seed = 1; seed <= 30; ++seed) {
    const auto finding = finding_of(diagnose(settled_robot(seed, 40 + seed % 3 * 40)), FindingKind::joint_lag);
    EXPECT_FALSE(finding) << seed << " " << words::sentence(*finding);
  }
}

TEST(JointLag, ErrorsOfTheGearsAreNotTakenForALag) {
  for (int seed = 1; seed <= 20; ++seed) {
    const auto finding = finding_of(diagnose(settled_robot(seed, 60 + seed % 2 * 60, 4e-4)), FindingKind::joint_lag);
    EXPECT_FALSE(finding) << seed << " " << words::sentence(*finding);
  }
}

}  // namespace
}  // namespace kinfer
