// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/tracker.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "repeats.hpp"
#include "track/tracked_case.hpp"

// Counts allocations of the whole program, Eigen's included. Sanitizers bring their own allocator.
#if defined(__GLIBC__) && !KINFER_HAS_SANITIZER
namespace {
std::atomic<long> allocation_count{0};
}
extern "C" {
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  ++allocation_count;
  return __libc_malloc(size);
}
}
#define KINFER_COUNTS_ALLOCATIONS 1
#endif

namespace kinfer::track {
namespace {

constexpr int telescope = 2;  // of the crane's joints

Case crane_with_a_telescope() {
  Case made = make_case({.machine = "crane", .duration = 120.0, .machine_seed = 12, .drive_seed = 1012});
  const auto q = made.drive.motion.q.row(made.drive.machine.base_dof + telescope);
  const auto qd = made.drive.motion.qd.row(made.drive.machine.base_dof + telescope);
  made.model.joints[telescope].range = {
      {.lower = q.minCoeff(), .upper = q.maxCoeff(), .speed = qd.cwiseAbs().maxCoeff(), .acceleration = 0.5}};
  return made;
}

TEST(Tracker, FollowsAnExcavatorFromRestWithoutKnowingItsSensorsErrors) {
  const Outcome out = run(still_excavator(), {}, unchanged);
  EXPECT_TRUE(out.is_relative[0]) << "level ground tells nothing of a vertical axis";
  EXPECT_LT(out.rms(0), 0.4 * degree);
  for (int j = 1; j < 5; ++j) {
    EXPECT_FALSE(out.is_relative[static_cast<std::size_t>(j)]);
    EXPECT_LT(out.rms(j), 0.06 * degree) << j;
  }
  EXPECT_TRUE(out.alarms.empty());
}

/// Alone for 17 s, a telescope is known by its acceleration only. Means of it over the rows of an update are as good as
/// all rows: taken as single values, they let the standard deviation grow to 0.35 m. Before it has moved it may be
/// anywhere in its range, and is stated to be.
TEST(Tracker, ATelescopeThatMovesAloneIsFollowedByItsAcceleration) {
  const Case given = crane_with_a_telescope();
  const Outcome out = run(given, {}, unchanged);
  EXPECT_LT(out.rms(telescope), 0.05);
  EXPECT_LT(out.largest_late_sd[telescope], 0.2);
  EXPECT_GT(out.largest_sd[telescope], 0.2);
}

constexpr double rest_of_drive = 3.0;  // [s] of the drive's begin

/// A tracker after the drive's rest, five times in a row, with `change` made to each row.
template <class Change>
Tracker after_long_rest(const Case& given, Change change) {
  Tracker tracker(given.model);
  InsRow row;
  for (int again = 0; again < 5; ++again)
    for (std::size_t r = 0; r < 600; ++r) {
      test::fill_row(given.drive.recording, r, row);
      row.time += again * rest_of_drive;
      change(row);
      tracker.add(row);
    }
  return tracker;
}

/// While it rests nothing tells where the telescope stands, and the places of its grid stay open.
TEST(Tracker, ASensorThatTurnsBeforeTheTelescopeIsPlacedIsNamed) {
  const Case given = crane_with_a_telescope();
  const Mat3 turn = exp_so3(Vec3(0.03, 0.03, 0.03));
  constexpr double turned_from = 3.0 * rest_of_drive;
  const Tracker tracker = after_long_rest(given, [&](InsRow& row) {
    if (row.time > turned_from) turn_sensor(row.sensors[2], turn);
  });
  ASSERT_EQ(tracker.state().alarms.size(), 1u);
  EXPECT_EQ(tracker.state().alarms[0].kind, TrackAlarmKind::sensor_moved);
  EXPECT_EQ(tracker.state().alarms[0].sensor, 2);
  EXPECT_NEAR(tracker.state().alarms[0].since, turned_from, 1.0);
}

/// A machine that rests, turned as a whole about its base sensor: what its sensors measure besides.
class RockedAtRest {
 public:
  explicit RockedAtRest(const MachineMotion& motion) : motion_(motion) {}

  void operator()(double since, InsRow& row) const {
    const double phase = frequency * since, angle = amplitude * std::sin(phase);
    const Vec3 axis = Vec3(1.0, 0.5, 0.0).normalized(), rate = amplitude * frequency * std::cos(phase) * axis,
               acceleration = -frequency * frequency * angle * axis;
    const Mat3 turn = exp_so3(angle * axis);
    for (std::size_t s = 0; s < row.sensors.size(); ++s) {
      const Mat3 world_R_sensor = turn * motion_.sensors[s].world_R_sensor[0].toRotationMatrix();
      const Vec3 arm = turn * (motion_.sensors[s].position[0] - motion_.sensors[0].position[0]);
      const Vec3 up = standard_gravity * Vec3::UnitZ(), moved = acceleration.cross(arm) + rate.cross(rate.cross(arm));
      row.sensors[s].angular_velocity += world_R_sensor.transpose() * rate;
      row.sensors[s].acceleration += world_R_sensor.transpose() * (up + moved - turn * up);
    }
  }

 private:
  static constexpr double amplitude = 0.03, frequency = 2.0;  // [rad], [rad/s]
  const MachineMotion& motion_;
};

/// The base counted as still until the telescope was placed, and its motion as evidence of where that is.
TEST(Tracker, ABaseThatBeginsToMoveIsSeenWhileTheTelescopeIsNotPlaced) {
  const Case given = crane_with_a_telescope();
  const RockedAtRest rock(given.drive.motion);
  constexpr double from = 2.0 * rest_of_drive;
  const Tracker tracker = after_long_rest(given, [&](InsRow& row) {
    if (row.time > from) rock(row.time - from, row);
  });
  EXPECT_TRUE(tracker.state().alarms.empty());
  EXPECT_EQ(tracker.filter().state().base, BaseMode::moving);
  const double error = tracker.state().q[telescope] - given.drive.q(telescope, 0);
  EXPECT_LT(std::abs(error), 4.0 * tracker.state().sd_q[telescope]) << error;
}

TEST(Tracker, ACopyGoesOnAlike) {
  const Case& given = still_excavator();
  Tracker one(given.model);
  InsRow row;
  for (std::size_t r = 0; r < 2000; ++r) {
    test::fill_row(given.drive.recording, r, row);
    one.add(row);
  }
  Tracker other = one;
  for (std::size_t r = 2000; r < 2200; ++r) {
    test::fill_row(given.drive.recording, r, row);
    one.add(row);
    other.add(row);
  }
  EXPECT_EQ(one.state().q, other.state().q);
  EXPECT_EQ(one.state().sd_q, other.state().sd_q);
}

#if defined(KINFER_COUNTS_ALLOCATIONS)
TEST(Tracker, AllocatesNothingForARow) {
  const Case& given = still_excavator();
  Tracker tracker(given.model);
  InsRow row;
  for (std::size_t r = 0; r < 600; ++r) {
    test::fill_row(given.drive.recording, r, row);
    tracker.add(row);
  }
  ASSERT_TRUE(tracker.state().started);
  long allocated = 0;
  for (std::size_t r = 600; r < 1600; ++r) {
    test::fill_row(given.drive.recording, r, row);
    const long before = allocation_count;
    tracker.add(row);
    allocated += allocation_count - before;
  }
  EXPECT_EQ(allocated, 0);
}
#endif

}  // namespace
}  // namespace kinfer::track
