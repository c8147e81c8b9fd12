// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "kinfer/identify/screening/synchronisation.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer {
using namespace identify;
namespace {

/// Three resting sensors on two loggers, 0 .. 10 s.
InsRecording three_clocks() {
  InsRecording recording;
  recording.loggers.resize(2);
  for (InsLogger& logger : recording.loggers)
    for (int row = 0; row <= 1000; ++row) logger.time.push_back(0.01 * row);
  for (const std::size_t logger : {0U, 0U, 1U}) {
    InsSensor sensor{.name = std::string(1, static_cast<char>('a' + recording.sensors.size())),
                     .logger = logger,
                     .acceleration = {},
                     .angular_velocity = {},
                     .field = {},
                     .faults = std::vector<std::uint8_t>(1001, 0)};
    for (auto& axis : sensor.acceleration.axis) axis.assign(1001, 1.0f);
    for (auto& axis : sensor.angular_velocity.axis) axis.assign(1001, 0.0f);
    recording.sensors.push_back(std::move(sensor));
  }
  return recording;
}

Synchronisation unsynchronised() {
  Synchronisation clock;
  clock.corrections.resize(3);
  return clock;
}

std::vector<ResidualClock> residual_of(double offset, double drift = 0.0) {
  return {{}, {}, {{.offset = offset, .drift = drift, .middle = 5.0}, 1e-5, 1e-6}};
}

TEST(UpdateClocks, ASmallCorrectionIsKeptButNothingIsRepeated) {
  const InsRecording recording = three_clocks();
  Synchronisation clock = unsynchronised();
  EXPECT_FALSE(update_clocks(clock, recording, {}));
  EXPECT_FALSE(update_clocks(clock, recording, residual_of(5e-4)));
  EXPECT_FALSE(clock.synchronised);
  EXPECT_NEAR(clock.corrections[2].shift_at(5.0), 5e-4, 1e-9);
}

TEST(UpdateClocks, ALargeOneMovesTheSamplesAndAllLaterOnesAddUp) {
  const InsRecording recording = three_clocks();
  Synchronisation clock = unsynchronised();
  EXPECT_TRUE(update_clocks(clock, recording, residual_of(0.02)));
  EXPECT_EQ(clock.clock_treatment, ClockTreatment::estimated);
  ASSERT_TRUE(clock.synchronised);
  const InsRecording& moved = clock.of(recording);
  EXPECT_NEAR(moved.time(moved.sensors[2]).front(), 0.02, 1e-9);
  EXPECT_NEAR(moved.time(moved.sensors[0]).front(), 0.0, 1e-12);
  EXPECT_TRUE(update_clocks(clock, recording, residual_of(-0.005, 1e-4)));
  EXPECT_NEAR(clock.corrections[2].shift_at(5.0), 0.015 + 1e-4 * 0.02, 1e-9);
  EXPECT_NEAR(clock.corrections[2].drift, 1e-4, 1e-9);
  EXPECT_NEAR(clock.of(recording).time(clock.of(recording).sensors[2]).back(), 10.0155, 1e-5);
}

TEST(UpdateClocks, ADriftThatIsNoticeableAtTheEndsOnlyCounts) {
  const InsRecording recording = three_clocks();
  Synchronisation clock = unsynchronised();
  EXPECT_TRUE(update_clocks(clock, recording, residual_of(0.0, 3e-4))) << "1.5 ms at either end";
  clock = unsynchronised();
  EXPECT_FALSE(update_clocks(clock, recording, residual_of(0.0, 1e-4)));
}

TEST(ReportClocks, NothingIsReportedWhereTheClocksAgree) {
  const ClockReport report = report_clocks(unsynchronised(), three_clocks(), {});
  EXPECT_TRUE(report.clocks.empty());
  EXPECT_TRUE(report.findings.empty());
}

TEST(ReportClocks, EveryClockIsListedAndNotableCorrectionsAreFindings) {
  Synchronisation clock = unsynchronised();
  clock.corrections[1].offset = 1e-4;  // harmless
  clock.corrections[2] = {.offset = 0.03, .drift = 2e-5, .middle = 0.0};
  const ClockReport report = report_clocks(clock, three_clocks(), residual_of(0.0));
  ASSERT_EQ(report.clocks.size(), 3U);
  EXPECT_NEAR(report.clocks[2].offset, 0.03 + 2e-5 * 5.0, 1e-12) << "in the middle of the recording";
  EXPECT_DOUBLE_EQ(report.clocks[2].offset_sd, 1e-5);
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].kind, FindingKind::clock);
  EXPECT_EQ(report.findings[0].values.text("sensor"), "c");
  EXPECT_TRUE(report.findings[0].applied);
  EXPECT_NE(words::sentence(report.findings[0]).find("30"), std::string::npos) << "milliseconds";
}

TEST(RestrictTo, KeepsSensorsTimeAndTheirCorrections) {
  const InsRecording recording = three_clocks();
  Synchronisation clock = unsynchronised();
  ASSERT_TRUE(update_clocks(clock, recording, residual_of(0.02)));
  restrict_to(clock, recording, {.sensors = {0, 2}, .begin = 2.0, .end = 8.0, .findings = {}});
  restrict_to(clock, clock.of(recording), {.sensors = {0, 1}, .begin = 1.0, .end = 7.0, .findings = {}});
  const InsRecording& part = clock.of(recording);
  ASSERT_EQ(part.sensors.size(), 2U);
  EXPECT_EQ(part.sensors[1].name, "c");
  EXPECT_NEAR(clock.corrections[1].offset, 0.02, 1e-9);
  for (const InsSensor& sensor : part.sensors) {
    EXPECT_GE(part.time(sensor).front(), 2.0) << "the part of both restrictions";
    EXPECT_LE(part.time(sensor).back(), 7.0);
    EXPECT_EQ(part.time(sensor).size(), sensor.rows());
  }
}

}  // namespace
}  // namespace kinfer
