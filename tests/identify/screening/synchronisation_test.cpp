// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/synchronisation.hpp"

#include <gmock/gmock.h>

#include "identify/driven_machine.hpp"
#include "kinfer/simulate/log_faults.hpp"
#include "kinfer/words/identification/verdict.hpp"
#include "repeats.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::driven_machine;
using test::DrivenMachine;
using test::has_finding;
using test::identified;
using test::worst_line_error;

const SensorClockEstimate& clock_of(const Identification& found, const std::string& sensor) {
  const auto place = std::ranges::find(found.clocks, sensor, &SensorClockEstimate::sensor);
  EXPECT_NE(place, found.clocks.end());
  return *place;
}

/// Relative to the clock of ins3, which was not changed.
double relative_offset(const Identification& found, const std::string& sensor) {
  return clock_of(found, sensor).offset - clock_of(found, "ins3").offset;
}

TEST(Synchronisation, OffsetAndDriftingLoggerClocksCostNoAccuracy) {
  const DrivenMachine drive = test::driven_arm(1, 5);
  const double before = worst_line_error(identified(drive.recording).joints, drive.truth);
  const InsRecording apart = with_clock_fault(with_clock_fault(drive.recording, {.sensor = 2, .offset = 0.05}),
                                              {.sensor = 4, .offset = -0.03, .drift = 5e-5});
  const Identification found = identified(apart);
  EXPECT_LT(worst_line_error(found.joints, drive.truth), std::max(2.0 * before, 3e-3));
  EXPECT_NEAR(relative_offset(found, "ins2"), -0.05, 4.0 * clock_of(found, "ins2").offset_sd + 5e-5);
  EXPECT_NEAR(relative_offset(found, "ins4"), 0.03, 4.0 * clock_of(found, "ins4").offset_sd + 5e-5);
  EXPECT_NEAR(clock_of(found, "ins4").drift - clock_of(found, "ins3").drift, -5e-5, 1e-5);
  EXPECT_TRUE(has_finding(found, "clock", "ins2"));
  EXPECT_THAT(words::identification_verdict(found), testing::HasSubstr("ins2"));
}

TEST(Synchronisation, TheClockThatTheOthersDisagreeWithIsTheOddOne) {
  const DrivenMachine drive = test::driven_arm(1, 5);
  const InsRecording apart = with_clock_fault(drive.recording, {.sensor = 3, .offset = 0.02, .drift = 1e-3});
  for (const bool is_first : test::repeats({true, false})) {
    InsRecording log = apart;
    if (is_first) {
      std::swap(log.loggers[0], log.loggers[log.sensors[3].logger]);
      const std::size_t odd = log.sensors[3].logger;
      for (InsSensor& sensor : log.sensors)
        sensor.logger = sensor.logger == odd ? 0 : sensor.logger == 0 ? odd : sensor.logger;
    }
    const Identification found = identified(log);
    EXPECT_EQ(found.joints.size(), drive.truth.joints.size());
    EXPECT_NEAR(clock_of(found, "ins3").drift, -1e-3, 5e-5) << is_first;
    EXPECT_NEAR(clock_of(found, "ins2").drift, 0.0, 5e-5) << is_first;
    EXPECT_LT(worst_line_error(found.joints, drive.truth), 3e-3) << is_first;
  }
}

TEST(Synchronisation, ADelayedSensorInTheSameFileIsFoundToo) {
  const DrivenMachine drive = test::driven_arm(2, 5);
  const double before = worst_line_error(identified(drive.recording).joints, drive.truth);
  const Identification found = identified(with_delayed_rows(drive.recording, 4, 5));  // 50 ms
  EXPECT_LT(worst_line_error(found.joints, drive.truth), std::max(2.0 * before, 3e-3));
  EXPECT_NEAR(relative_offset(found, "ins4"), -0.05, 5e-4);
  EXPECT_TRUE(has_finding(found, "clock", "ins4 are logged"));
}

TEST(Synchronisation, LeavesMachinesWhoseClocksAgreeUnchanged) {
  for (const std::string& name : machine_names())
    for (const Script script : test::repeats({Script::together, Script::gentle})) {
      const Synchronisation clock = synchronise_sensors(driven_machine(name, 4, script).recording, {}, 0);
      EXPECT_EQ(clock.clock_treatment, ClockTreatment::checked) << name;
      EXPECT_TRUE(std::ranges::all_of(clock.corrections, &ClockCorrection::is_none)) << name;
    }
  EXPECT_TRUE(identified(driven_machine("tree", 4, Script::together).recording).clocks.empty());
}

TEST(Synchronisation, GivesTheSameBitsForAnyNumberOfThreads) {
  const InsRecording late = with_delayed_rows(driven_machine("excavator", 1, Script::together).recording, 2, 5);
  const Synchronisation one = synchronise_sensors(late, {}, 1);
  ASSERT_TRUE(one.synchronised);
  for (const int threads : {2, 7}) {
    const Synchronisation many = synchronise_sensors(late, {}, threads);
    ASSERT_EQ(many.corrections.size(), one.corrections.size());
    for (std::size_t s = 0; s < one.corrections.size(); ++s)
      EXPECT_EQ(one.corrections[s].offset, many.corrections[s].offset);
  }
}

}  // namespace
}  // namespace kinfer
