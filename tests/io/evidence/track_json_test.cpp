// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/track_json.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "kinfer/io/evidence/evidence_file.hpp"

namespace kinfer {
namespace {

using ::testing::HasSubstr;

TrackRun example_run() {
  const double nothing = std::nan("");
  TrackRun run{.begin = 1.0, .end = 3.0, .rows = 400, .time = {1.25, 1.75, 2.5}};
  run.positions.push_back(
      {.name = "ins0-ins1", .low = {0.1, 0.2, nothing}, .high = {0.2, 0.3, nothing}, .sd = {0.01, 0.02, nothing}});
  run.positions.push_back(
      {.name = "ins1-ins2", .rotates = false, .low = {1, 2, 3}, .high = {1, 2, 3}, .sd = {0, 0, 0}});
  run.sensors.push_back({.name = "ins0", .innovation = {0.9, 1.1, 40.0}});
  run.tool = {Vec3(1, 2, 3), Vec3::Constant(nothing), Vec3(1, 2, 4)};
  run.tool_sd = {0.001, 0.002, 0.003};
  run.joints = {{.name = "ins0-ins1", .composed = 0.25, .relative_to_start = 1.0}, {.name = "ins1-ins2"}};
  run.events.push_back(
      {.alarm = {TrackAlarmKind::sensor_moved, 0, -1, 2.0, 13.0}, .until = nothing, .sentence = "moved"});
  run.events.push_back({.alarm = {TrackAlarmKind::sensor_moved, 1, -1, 0.1, 4.0, SensorTurn{0.03, 0.001, 0.05}},
                        .until = nothing,
                        .sentence = "turned"});
  run.events.push_back({.alarm = {TrackAlarmKind::restarted, -1, -1, 1.5, 0.0}, .until = 1.6, .sentence = "again"});
  run.remarks = {"the last line is cut off"};
  return run;
}

TEST(TrackJson, IsReadBackWithTheSameBytes) {
  const TrackRun run = track_evidence(example_run(), {.inputs = {{"imu.csv", "00"}}, .options = {{"--base", "auto"}}});
  const std::string text = format_track_run(run);
  const auto read = read_track_run(text);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(format_track_run(*read), text);
  EXPECT_TRUE(std::isnan(read->events[0].until));
  EXPECT_EQ(read->events[0].alarm, run.events[0].alarm);
  EXPECT_EQ(read->events[1].alarm, run.events[1].alarm);
  EXPECT_EQ(read->verdict.usability, Usability::use_with_care);
  EXPECT_FALSE(read->tool[1].allFinite());
  const auto any = read_evidence(text);
  ASSERT_TRUE(any);
  EXPECT_TRUE(std::holds_alternative<TrackRun>(*any));
}

TEST(TrackJson, SaysWhatHappened) {
  const TrackRun run = track_evidence(example_run(), {});
  EXPECT_THAT(run.verdict.sentence, HasSubstr("2 joint positions tracked over 2.0 s, 2 alarms"));
  EXPECT_THAT(run.verdict.sentence, HasSubstr("relative to where tracking began, which --start can state: ins0-ins1"));
  EXPECT_THAT(run.events[0].sentence, HasSubstr("ins0 does not agree with the chain"));
  EXPECT_THAT(run.events[1].sentence, HasSubstr("was turned by 1.72 ± 0.06 deg"));
  TrackRun other = example_run();
  other.events.push_back({.alarm = {TrackAlarmKind::does_not_fit, -1, -1, 1.1, 9.0}, .until = std::nan("")});
  EXPECT_EQ(track_evidence(other, {}).verdict.usability, Usability::do_not_use);
}

TEST(TrackJson, CurvesOfOtherLengthsAreAnError) {
  TrackRun run = example_run();
  run.tool_sd.pop_back();
  const auto read = read_track_run(format_track_run(run));
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, HasSubstr("expected as many times as values"));
}

}  // namespace
}  // namespace kinfer
