// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/held_out.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "kinfer/identify/pipeline.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "simulate/worlds.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;

TEST(HeldOut, AFifthOfTheRecordingIsHeldOutInWindowsSpreadOverIt) {
  const SplineGrid grid{2.0, 0.1, 530};
  const auto intervals = held_out_intervals(grid);
  ASSERT_EQ(intervals.size(), 5u);
  Index held = 0, before = 0;
  for (const auto& [begin, end] : intervals) {
    EXPECT_GT(begin, before);
    EXPECT_LE(end, grid.intervals);
    held += end - begin;
    before = end;
  }
  EXPECT_NEAR(static_cast<double>(held), 106.0, 5.0);
}

InsSensor shaking(std::span<const double> time, double amplitude) {
  InsSensor sensor{.name = "a", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  for (const double t : time)
    for (std::size_t k = 0; k < 3; ++k) {
      sensor.angular_velocity.axis[k].push_back(0.0f);
      sensor.acceleration.axis[k].push_back(
          static_cast<float>(k == 2 ? 9.81 + (t > 1.0 && t < 1.2 ? amplitude : 0.0) : 0.0));
    }
  sensor.faults.assign(time.size(), 0);
  return sensor;
}

TEST(HeldOut, SamplesOfAWindowDoNotAffectTheFit) {
  InsProblem problem;
  problem.grid = {0.0, 0.1, 20};
  problem.prior = {.gyroscope_bias = 1e-3, .accelerometer_bias = 1e-2};
  problem.gravity_sd = 10.0;
  std::vector<double> time;
  for (double t = 0.0; t < 2.0; t += 0.01) time.push_back(t);
  const InsSensor sensor = shaking(time, 3.0);
  problem.sensors.resize(1);
  problem.sensors[0].angular_velocity = ins_blocks(sensor, time, InsInstrument::gyroscope, problem.grid);
  problem.sensors[0].force = ins_blocks(sensor, time, InsInstrument::accelerometer, problem.grid);
  problem.sensors[0].noise =
      problem.sensors[0].noise_floor = {.angular_velocity = 1e-3, .force = 5.0};  // nothing is an outlier
  InsUnknowns start;
  start.bodies = {{.sensor = 0}};
  start.spline_coefficients.resize(0, problem.grid.coefficients());
  start.root_force = Vec3(0.0, 0.0, 9.0);
  start.errors.resize(1);
  const auto blocks = problem.sensors[0].force;
  const double seen = fit_ins(problem, start, {}).unknowns.root_force.z();
  problem.sensors[0].noise = problem.sensors[0].noise_floor;
  const double unseen = fit_without_intervals(problem, start, {{10, 12}}, {}).unknowns.root_force.z();
  EXPECT_GT(seen, 10.0);
  EXPECT_NEAR(unseen, 9.81, 0.01);
  for (std::size_t k = 0; k < blocks.size(); ++k) EXPECT_EQ(problem.sensors[0].force[k].target, blocks[k].target);
  EXPECT_EQ(problem.sensors[0].noise.force, problem.sensors[0].noise_floor.force);
}

TEST(HeldOut, ASimulatedMachineIsPredictedInWindowsThatWereNotFitted) {
  const MujocoWorld world = test::world_of("excavator-general", {}, 5);
  const MachineMotion motion = world.prescribe(test::drive_of(world.machine(), {}, 5), 100.0);
  const InsRecording recording = simulate_recording(world.machine(), motion, *sensor_grade("industrial"), {}, Rng(5));
  const auto found = identify_machine(recording, {.links = 2}, Rng(1));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->motion.held_out.size(), 5u);
  for (const Trace& trace : found->motion.traces) {
    EXPECT_GT(trace.rms_holdout, 0.0);
    EXPECT_LT(trace.rms_holdout, 0.2 * trace.rms_measured + 0.01) << trace.sensor << ' ' << name(trace.quantity);
  }
  double seconds = 0.0;
  for (const TimeWindow& window : found->motion.held_out) seconds += window.end - window.begin;
  EXPECT_DOUBLE_EQ(found->prediction.held_out_seconds, seconds);
}

}  // namespace
}  // namespace kinfer
