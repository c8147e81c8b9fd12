// SPDX-License-Identifier: Apache-2.0
// Faults injected into logs, machines made of chains, and the small parts of simulated motion.
#include "kinfer/simulate/log_faults.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/kinematics/forward.hpp"
#include "kinfer/simulate/compliant_mounts.hpp"
#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/machine_files.hpp"
#include "kinfer/simulate/machine_from_chain.hpp"
#include "kinfer/simulate/prescribed_motion.hpp"
#include "support/carried_sensor.hpp"

namespace kinfer {
namespace {

InsRecording two_sensors() {
  const testing::CarriedSensor c = testing::carried({.seconds = 5.0});
  InsRecording recording;
  recording.loggers = {{"log.csv", c.time}};
  recording.sensors = {c.sensor, c.sensor};
  recording.sensors[0].name = "ins0", recording.sensors[1].name = "ins1";
  return recording;
}

TEST(ClockFaultIn, AffectsTheTimesOfOneSensorOnly) {
  const InsRecording sound = two_sensors();
  const InsRecording faulty = with_clock_fault(sound, {.sensor = 1, .offset = 0.3, .drift = 0.01});
  EXPECT_EQ(faulty.loggers[0].time, sound.loggers[0].time);
  EXPECT_EQ(faulty.sensors[0].logger, 0u);
  EXPECT_EQ(faulty.loggers[faulty.sensors[1].logger].name, "ins1.csv");
  const auto time = faulty.time(faulty.sensors[1]), true_time = sound.time(sound.sensors[1]);
  const double middle = 0.5 * (true_time.front() + true_time.back());
  for (const std::size_t row : {0u, 400u, 999u})
    EXPECT_NEAR(time[row] - true_time[row], 0.3 + 0.01 * (true_time[row] - middle), 1e-12);
  EXPECT_EQ(faulty.sensors[1].acceleration.axis, sound.sensors[1].acceleration.axis);
}

TEST(DelayedRows, RepeatTheMeasurementsLaterAndTheFirstAreMissing) {
  const InsRecording sound = two_sensors(), late = with_delayed_rows(sound, 1, 7);
  for (std::size_t row = 0; row < 7; ++row) {
    EXPECT_TRUE(std::isnan(late.sensors[1].acceleration.axis[0][row]));
    EXPECT_EQ(late.sensors[1].faults[row], acceleration_missing | angular_velocity_missing | field_missing);
  }
  for (std::size_t row = 7; row < late.sensors[1].rows(); ++row) {
    ASSERT_EQ(late.sensors[1].angular_velocity.axis[2][row], sound.sensors[1].angular_velocity.axis[2][row - 7]);
    ASSERT_EQ(late.sensors[1].faults[row], sound.sensors[1].faults[row - 7]);
  }
  EXPECT_EQ(late.sensors[0].acceleration.axis, sound.sensors[0].acceleration.axis);
  EXPECT_DEATH(with_delayed_rows(sound, 2, 1), "");
}

/// A sensor that turns about z at 2 rad/s, 0.5 m from the axis, without gravity.
MachineMotion turntable_motion() {
  MachineMotion motion;
  motion.sensors.resize(1);
  SensorMotion& m = motion.sensors[0];
  for (int row = 0; row < 100; ++row) {
    const double t = 0.01 * row, angle = 2.0 * t;
    motion.time.push_back(t);
    m.world_R_sensor.push_back(Quat(rot_z(angle)));
    m.position.push_back(0.5 * Vec3(std::cos(angle), std::sin(angle), 0));
    m.force.emplace_back(-0.5 * 4.0, 0, 0);
    m.angular_velocity.emplace_back(0, 0, 2.0);
    m.field.push_back(rot_z(-angle) * Vec3(20, 0, -40));
  }
  return motion;
}

TEST(Remount, MeasuresAtItsNewPlaceFromItsRowOn) {
  const Pose old_T_new{rot_z(std::numbers::pi / 2), Vec3(0.3, 0, 0)};  // further out, turned left
  const MachineMotion sound = turntable_motion(), moved = with_remount(sound, 0, 40, old_T_new);
  const SensorMotion &was = sound.sensors[0], &is = moved.sensors[0];
  EXPECT_EQ(is.force[39], was.force[39]);
  EXPECT_EQ(is.position[39], was.position[39]);
  for (const std::size_t row : {40u, 70u, 99u}) {
    EXPECT_LT((is.force[row] - Vec3(0, 0.8 * 4.0, 0)).norm(), 1e-12) << "towards the axis, which is now on its right";
    EXPECT_LT((is.angular_velocity[row] - Vec3(0, 0, 2)).norm(), 1e-12);
    EXPECT_LT((is.position[row] - 1.6 * was.position[row]).norm(), 1e-12);
    EXPECT_LT((is.world_R_sensor[row] * is.field[row] - Vec3(20, 0, -40)).norm(), 1e-10);
  }
}

TEST(MergedRecordings, HaveAllSensorsForTheTimeThatBothLast) {
  const InsRecording one = two_sensors();
  InsRecording other = one;
  other.loggers[0].time.resize(600);
  for (InsSensor& sensor : other.sensors) {
    sensor.faults.resize(600);
    for (TriadColumns* columns : {&sensor.acceleration, &sensor.angular_velocity, &sensor.field})
      for (auto& axis : columns->axis) axis.resize(600);
  }
  const InsRecording both = merge_recordings(one, other, "b_");
  ASSERT_EQ(both.sensors.size(), 4u);
  EXPECT_EQ(both.sensors[0].name, "ins0");
  EXPECT_EQ(both.sensors[3].name, "b_ins1");
  EXPECT_EQ(both.loggers.size(), 1u);
  for (const InsSensor& sensor : both.sensors) EXPECT_EQ(sensor.rows(), 600u);
}

/// As identify writes it: a moving joint "A-B", then the fixed frame of sensor "B".
Chain identified_chain() {
  Chain chain;
  const auto add = [&](const std::string& name, JointType type, int parent) {
    chain.joints.push_back(
        {.name = name, .parent = parent, .type = type, .link = UrdfLink{}, .is_active = type != JointType::fixed});
    std::get<UrdfLink>(chain.joints.back().link).origin.xyz = Vec3(0.1, 0.2, 0.3);
  };
  add("base-arm", JointType::revolute, -1), add("arm", JointType::fixed, 0);
  add("arm-hand", JointType::revolute, 1), add("hand", JointType::fixed, 2);
  return chain;
}

TEST(MachineFromChain, HasASensorOnEverySegmentAndTheRootAtTheBase) {
  const auto machine = make_machine(identified_chain());
  ASSERT_TRUE(machine) << machine.error().what;
  ASSERT_EQ(machine->sensors.size(), 3u);
  const std::vector<std::pair<std::string, int>> expected{{"base", -1}, {"arm", 0}, {"hand", 1}};
  for (std::size_t s = 0; s < 3; ++s) {
    EXPECT_EQ(machine->sensors[s].name, expected[s].first);
    EXPECT_EQ(machine->sensors[s].parent, expected[s].second);
  }
  EXPECT_EQ(machine->home.size(), 2);
  expect_well_formed(machine->chain);
  const VectorXd q = (VectorXd(2) << 0.3, -0.4).finished();
  EXPECT_LT((forward(machine->chain, q).position - forward(identified_chain(), q).position).norm(), 1e-15);
}

TEST(MachineFromChain, OtherChainsAreRefused) {
  Chain plain = identified_chain();
  for (Joint& joint : plain.joints) joint.name = "J";
  EXPECT_EQ(make_machine(plain).error().what, "the chain contains no sensors; expected a chain written by identify");
  Chain broken = identified_chain();
  broken.joints[2].name = "leg-hand";
  EXPECT_EQ(make_machine(broken).error().what, "joint leg-hand: sensor leg does not precede it in the chain");
}

TEST(MachineMotionOf, HasARowForEverySampleOfItsDuration) {
  EXPECT_EQ(row_count(10.0, 200.0), 2000u);
  EXPECT_EQ(row_count(0.1 * 3, 10.0), 3u) << "rounded, not cut off";
  const Machine machine = make_machine(identified_chain()).value();
  const MachineMotion motion = make_motion(machine, 50, 25.0);
  EXPECT_EQ(motion.time.size(), 50u);
  EXPECT_DOUBLE_EQ(motion.time.back(), 49 / 25.0);
  EXPECT_EQ(motion.q.rows(), 2);
  EXPECT_EQ(motion.sensors.size(), 3u);
  EXPECT_EQ(motion.sensors[2].force.size(), 50u);
}

TEST(MachineFiles, AreListedInTheOrderOfTheirNames) {
  std::vector<std::string_view> names;
  for (const MachineFile& file : machine_files()) {
    names.push_back(file.name);
    EXPECT_NE(file.mjcf.find("<mujoco"), std::string_view::npos) << file.name;
  }
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_EQ(names, (std::vector<std::string_view>{"crane", "excavator", "robot6", "tree"}));
}

TEST(Trajectory, IsAWindowedSineThatStartsAndEndsAtHome) {
  const JointTrajectory drive{.home = 0.7,
                              .movements = {{2.0, 10.0, {{.amplitude = 0.5, .frequency = 0.25, .phase = 0.3}}}}};
  for (const double t : {0.0, 2.0, 10.0, 50.0}) {
    EXPECT_EQ(state_at(drive, t).q, 0.7) << t;
    EXPECT_EQ(state_at(drive, t).qd, 0.0) << t;
  }
  for (const double t : {3.5, 5.0, 8.5}) {  // the window is one between its ramps
    const double angle = 2 * std::numbers::pi * 0.25 * (t - 2.0) + 0.3;
    EXPECT_NEAR(state_at(drive, t).q, 0.7 + 0.5 * std::sin(angle), 1e-12);
    EXPECT_NEAR(state_at(drive, t).qd, 0.25 * std::numbers::pi * std::cos(angle), 1e-12);
  }
  for (const double t : {2.3, 3.0, 9.4}) {
    constexpr double h = 1e-5;
    const double slope = (state_at(drive, t + h).q - state_at(drive, t - h).q) / (2 * h);
    const double bend = (state_at(drive, t + h).qd - state_at(drive, t - h).qd) / (2 * h);
    EXPECT_NEAR(state_at(drive, t).qd, slope, 1e-8);
    EXPECT_NEAR(state_at(drive, t).qdd, bend, 1e-8);
  }
}

TEST(FoamMounts, LeanASensorByAboutTheGivenAngleAndEachDifferently) {
  MachineMotion still = turntable_motion();
  for (Vec3& rate : still.sensors[0].angular_velocity) rate.setZero();
  for (Vec3& force : still.sensors[0].force) force = Vec3(0, 9.81, 0);
  still.sensors.resize(12, still.sensors[0]);
  const MachineMotion soft = with_foam_mounts(still, 0.05, Rng(3));
  double largest = 0.0, smallest = 1.0;
  for (const SensorMotion& m : soft.sensors) {
    EXPECT_NEAR(m.force.back().norm(), 9.81, 1e-6) << "gravity is turned, not scaled";
    const double lean = angle_between(m.force.back(), Vec3(0, 9.81, 0));
    largest = std::max(largest, lean), smallest = std::min(smallest, lean);
  }
  EXPECT_LT(largest, 0.15);
  EXPECT_GT(largest, 0.03);
  EXPECT_LT(smallest, 0.6 * largest);
}

}  // namespace
}  // namespace kinfer
