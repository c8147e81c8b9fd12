// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/time_stamps.hpp"

#include <gtest/gtest.h>

#include "identify/driven_machine.hpp"
#include "kinfer/inertial/sampling_grid.hpp"
#include "kinfer/simulate/log_faults.hpp"

namespace kinfer {
using namespace identify;
namespace {

const test::DrivenMachine& driven_excavator() {
  static const test::DrivenMachine machine = test::driven_arm(3, 4);
  return machine;
}

TEST(TimeStamps, OfASoundRecordingStayAsTheyAre) {
  const MendedTimeStamps mended = mend_time_stamps(driven_excavator().recording, 0);
  EXPECT_FALSE(mended.recording);
  EXPECT_TRUE(mended.findings.empty());
}

TEST(TimeStamps, ThatJitterGiveWayToRegularTimesAndAreNamed) {
  const InsRecording& sound = driven_excavator().recording;
  const MendedTimeStamps mended = mend_time_stamps(with_stamp_jitter(sound, 2e-3, Rng(1)), 0);
  ASSERT_TRUE(mended.recording);
  ASSERT_EQ(mended.findings.size(), 1u);
  EXPECT_EQ(mended.findings[0].kind, FindingKind::timestamp_jitter);
  EXPECT_NEAR(mended.findings[0].values.number("jitter"), 2e-3, 3e-4);
  EXPECT_NEAR(mended.findings[0].values.number("rows_per_packet"), 1.0, 1e-12);
  EXPECT_LT(time_scatter(mended.recording->loggers[0].time, sound.loggers[0].time), 1e-4);
}

TEST(TimeStamps, OfPacketsAreNamedWithTheirSize) {
  const InsRecording& sound = driven_excavator().recording;
  const MendedTimeStamps mended = mend_time_stamps(with_packets(sound, 10), 0);
  ASSERT_TRUE(mended.recording);
  ASSERT_EQ(mended.findings.size(), 1u);
  EXPECT_NEAR(mended.findings[0].values.number("rows_per_packet"), 10.0, 0.1);
  EXPECT_LT(time_scatter(mended.recording->loggers[0].time, sound.loggers[0].time), 2e-3);
}

TEST(TimeStamps, JitterCostsNoAccuracyAndIsNotBlamedOnTheMachine) {
  const Identification found = test::identified(with_stamp_jitter(driven_excavator().recording, 2e-3, Rng(1)));
  EXPECT_TRUE(test::has_finding(found, "timestamp_jitter", "scatter"));
  EXPECT_EQ(found.findings.size(), 1u);
  EXPECT_LT(test::worst_line_error(found.joints, driven_excavator().truth), 6e-3);
}

}  // namespace
}  // namespace kinfer
