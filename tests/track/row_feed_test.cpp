// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/rows/row_feed.hpp"

#include <gtest/gtest.h>

#include "kinfer/track/tracker.hpp"
#include "support/tracked_machine.hpp"

namespace kinfer::track {
namespace {

constexpr std::size_t late_sensor = 3, late_rows = 8;  // 40 ms

struct LateOutcome {
  double rms = 0.0;  // [rad] of the joint on the near side of the late sensor
  bool has_alarm = false;
};

LateOutcome track_late_sensor(const TrackingModel& model, const test::SimulatedDrive& drive) {
  RowFeed feed(model, 0.0);
  Tracker tracker(model);
  LateOutcome outcome;
  double squares = 0.0;
  Eigen::Index rows = 0, judged = 0;
  const auto add = [&](const InsRow& row) -> Result<void> {
    tracker.add(row);
    const Eigen::Index r = rows++;
    if (row.time < 5.0) return {};
    const double e = tracker.state().q[static_cast<Eigen::Index>(late_sensor) - 1] - drive.q(late_sensor - 1, r);
    squares += e * e;
    outcome.has_alarm |= !tracker.state().alarms.empty();
    ++judged;
    return {};
  };
  InsRow row, past;
  for (std::size_t r = 0; r < drive.recording.loggers.front().time.size(); ++r) {
    test::fill_row(drive.recording, r, row);
    test::fill_row(drive.recording, r < late_rows ? 0 : r - late_rows, past);
    row.sensors[late_sensor] = past.sensors[late_sensor];
    EXPECT_TRUE(feed.add(row, add));
  }
  EXPECT_TRUE(feed.finish(add));
  EXPECT_EQ(rows, static_cast<Eigen::Index>(drive.recording.loggers.front().time.size())) << "a row per row";
  outcome.rms = std::sqrt(squares / static_cast<double>(judged));
  return outcome;
}

TEST(RowFeed, CorrectsTheClockThatTheIdentificationFound) {
  const test::SimulatedDrive drive = test::simulated_drive({.duration = 30.0});
  TrackingModel model = test::tracking_model_of(drive.machine, *sensor_grade("industrial"), 200.0);
  const LateOutcome late = track_late_sensor(model, drive);
  model.sensors[late_sensor].clock_offset = -0.04;
  const LateOutcome corrected = track_late_sensor(model, drive);
  EXPECT_TRUE(late.has_alarm) << "otherwise the test shows nothing";
  EXPECT_FALSE(corrected.has_alarm);
  EXPECT_LT(corrected.rms, 0.001);
  EXPECT_LT(corrected.rms, 0.5 * late.rms);
}

}  // namespace
}  // namespace kinfer::track
