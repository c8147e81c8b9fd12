// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/run_recorder.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/example_tracking_model.hpp"

namespace kinfer {
namespace {

TrackState state_at(const TrackingModel& model, double time) {
  TrackState state;
  state.time = time;
  state.started = true;
  state.q = VectorXd::Constant(model.positions(), std::sin(time));
  state.qd = state.q;
  state.sd_q = state.sd_qd = VectorXd::Constant(model.positions(), 0.01);
  state.joints.assign(model.joints.size(), {JointSource::chain, JointReference::chain});
  state.innovation.assign(model.sensors.size(), 2.0);
  state.base_T_tool.position = Vec3(time, 0.0, 1.0);
  return state;
}

TEST(RunRecorder, KeepsEveryExtremeInBoundedMemory) {
  const TrackingModel model = test::example_tracking_model(1);
  track::RunRecorder recorder(model);
  const int rows = 70001;
  for (int i = 0; i < rows; ++i) {
    TrackState state = state_at(model, 0.005 * i);
    if (i == 31234) state.q[2] = 99.0;
    recorder.add(state);
  }
  const TrackRun run = recorder.run();
  EXPECT_EQ(run.rows, rows);
  EXPECT_EQ(run.begin, 0.0);
  EXPECT_DOUBLE_EQ(run.end, 0.005 * (rows - 1));
  EXPECT_LE(run.time.size(), 2000u);
  EXPECT_GT(run.time.size(), 900u);
  for (std::size_t i = 1; i < run.time.size(); ++i) EXPECT_GT(run.time[i], run.time[i - 1]);
  const auto& high = run.positions[2].high;
  EXPECT_EQ(*std::max_element(high.begin(), high.end()), 99.0);
  EXPECT_FALSE(run.positions[1].rotates) << "the slide";
  for (const TrackSensorCurve& sensor : run.sensors)
    for (const double value : sensor.innovation) EXPECT_NEAR(value, 2.0, 1e-12);
  EXPECT_EQ(run.joints[0].composed, 0.0);
}

TEST(RunRecorder, TurnsAlarmsIntoEvents) {
  const TrackingModel model = test::example_tracking_model(1);
  track::RunRecorder recorder(model);
  for (int i = 0; i < 100; ++i) {
    TrackState state = state_at(model, 0.1 * i);
    if (i >= 20 && i < 50) state.alarms.push_back({TrackAlarmKind::sensor_lost, 3, -1, 2.0, 1.0 + 0.1 * (i % 7)});
    if (i >= 55 && i < 57) state.alarms.push_back({TrackAlarmKind::sensor_lost, 3, -1, 5.5, 1.0});  // once more
    if (i >= 60) state.alarms.push_back({TrackAlarmKind::joint_changed, -1, 1, 6.0, 2.0});
    recorder.add(state);
  }
  const TrackRun run = recorder.run();
  ASSERT_EQ(run.events.size(), 2u);
  EXPECT_DOUBLE_EQ(run.events[0].until, 5.7);
  EXPECT_NEAR(run.events[0].alarm.strength, 1.6, 1e-12) << "the largest";
  EXPECT_TRUE(std::isnan(run.events[1].until)) << "still active";
}

}  // namespace
}  // namespace kinfer
