// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/scales/instrument_scales.hpp"

#include <gtest/gtest.h>

#include "identify/driven_machine.hpp"
#include "repeats.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::DrivenMachine;

void multiply(TriadColumns& triad, float factor) {
  for (auto& axis : triad.axis)
    for (float& value : axis) value *= factor;
}

const Finding* finding_of(const Identification& found, FindingKind kind) {
  const auto finding = std::ranges::find(found.findings, kind, &Finding::kind);
  return finding == found.findings.end() ? nullptr : &*finding;
}

/// Largest error of a point in the child's sensor over its standard deviation.
double worst_point_error(const Identification& found, const MachineTruth& truth) {
  double worst = 0.0;
  for (const JointTruth& joint : truth.joints) {
    const auto f = std::ranges::find(found.joints, joint.child, &JointEstimate::child);
    if (f == found.joints.end() || joint.type != JointType::revolute || !joint.unobservable_in_child.empty()) continue;
    worst = std::max(worst, test::line_error(*f, joint) / std::hypot(f->sd.point_in_child[0], f->sd.point_in_child[1]));
  }
  return worst;
}

TEST(InstrumentScales, OneGyroscopeThatReadsTooMuchIsCorrectedAndNamed) {
  DrivenMachine drive = test::driven_arm(4, 4);
  multiply(drive.recording.sensors[2].angular_velocity, 1.02f);
  const Identification found = test::identified(drive.recording);
  const Finding* finding = finding_of(found, FindingKind::instrument_scale);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->values.text("sensor"), drive.recording.sensors[2].name);
  EXPECT_EQ(finding->values.text("instrument"), "gyroscope");
  EXPECT_EQ(finding->values.text("part"), "all");
  EXPECT_NEAR(finding->values.number("scale"), 0.02, 2e-3);
  EXPECT_FALSE(finding_of(found, FindingKind::clock_rate));
  EXPECT_LT(worst_point_error(found, drive.truth), 2.5);
}

TEST(InstrumentScales, WhichOfTwoTurnedInstrumentsIsRightStaysUncertain) {
  DrivenMachine drive = test::driven_machine("tree", 4);
  const Mat3 turned = exp_so3(Vec3(0.0, 0.0, 0.02));
  TriadColumns& rates = drive.recording.sensors[2].angular_velocity;
  for (std::size_t row = 0; row < rates.axis[0].size(); ++row) {
    const Vec3 rate = turned * rates.at(row);
    for (std::size_t k = 0; k < 3; ++k) rates.axis[k][row] = static_cast<float>(rate[static_cast<Eigen::Index>(k)]);
  }
  const Identification found = test::identified(drive.recording);
  const Finding* finding = finding_of(found, FindingKind::instrument_scale);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->values.text("part"), "turned");
  EXPECT_NEAR(finding->values.number("scale"), 0.02, 2e-3);
  EXPECT_NE(found.usability, Usability::use);
  EXPECT_LT(worst_point_error(found, drive.truth), 2.5);
}

TEST(InstrumentScales, AClockThatIsFastLeavesTheLengthsUncertain) {
  DrivenMachine drive = test::driven_arm(4, 4);
  for (InsLogger& logger : drive.recording.loggers)
    for (double& time : logger.time) time *= 1.05;
  const Identification found = test::identified(drive.recording);
  const Finding* finding = finding_of(found, FindingKind::clock_rate);
  ASSERT_TRUE(finding);
  EXPECT_NEAR(finding->values.number("scale"), 0.05, 3e-3);
  EXPECT_NE(found.usability, Usability::use);
  EXPECT_LT(worst_point_error(found, drive.truth), 2.5);
}

TEST(InstrumentScales, AClockOfAnyRateIsNamed) {
  for (const double rate : test::repeats({0.1, 0.25, 2.0})) {
    DrivenMachine drive = test::driven_machine("crane", 4);
    for (InsLogger& logger : drive.recording.loggers)
      for (double& time : logger.time) time *= rate;
    const Identification found = test::identified(drive.recording);
    const Finding* finding = finding_of(found, FindingKind::clock_rate);
    ASSERT_TRUE(finding) << rate;
    EXPECT_NEAR((1.0 + finding->values.number("scale")) / rate, 1.0, 0.01);
    EXPECT_NE(found.usability, Usability::use);
    EXPECT_LT(worst_point_error(found, drive.truth), 2.5) << rate;
  }
}

TEST(InstrumentScales, AccelerometersThatAllReadTooMuchAreCorrectedByGravity) {
  for (const float factor : test::repeats({0.94f, 1.0194f, 1.1f})) {
    DrivenMachine drive = test::driven_arm(4, 4);
    for (InsSensor& sensor : drive.recording.sensors) multiply(sensor.acceleration, factor);
    const Identification found = test::identified(drive.recording);
    const Finding* finding = finding_of(found, FindingKind::force_scale);
    ASSERT_TRUE(finding) << factor;
    EXPECT_TRUE(finding->applied);
    EXPECT_NEAR(finding->values.number("scale"), double{factor} - 1.0, 2.0 * finding->values.number("sd"));
    EXPECT_LT(finding->values.number("sd"), 4e-3);
    EXPECT_LT(worst_point_error(found, drive.truth), 2.5) << factor;
  }
}

TEST(InstrumentScales, SoundInstrumentsAreNotNamed) {
  const DrivenMachine drive = test::driven_arm(4, 4);
  const Identification found = test::identified(drive.recording);
  EXPECT_FALSE(finding_of(found, FindingKind::instrument_scale));
  EXPECT_FALSE(finding_of(found, FindingKind::clock_rate));
  EXPECT_FALSE(finding_of(found, FindingKind::force_scale));
}

}  // namespace
}  // namespace kinfer
