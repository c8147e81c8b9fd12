// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/compliant_mounts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulate/worlds.hpp"

namespace kinfer {
namespace {

/// One sensor on a segment that is stationary or rotates slowly about x.
MachineMotion rotating_sensor(double angular_velocity, double until) {
  MachineMotion motion;
  motion.sensors.resize(1);
  SensorMotion& m = motion.sensors[0];
  for (double t = 0.0; t < until; t += 0.005) {
    const Mat3 sensor_R_world = exp_so3(Vec3(-angular_velocity * t, 0.0, 0.0));
    motion.time.push_back(t);
    m.world_R_sensor.push_back(Quat(Mat3(sensor_R_world.transpose())));
    m.position.emplace_back(Vec3::Zero());
    m.force.push_back(sensor_R_world * Vec3(0.0, 0.0, 9.81));
    m.angular_velocity.emplace_back(angular_velocity, 0.0, 0.0);
    m.field.push_back(sensor_R_world * Vec3(1.5, 20.5, -44.0));
  }
  return motion;
}

CompliantMount tilting_mount(double tilt) {
  CompliantMount mount;
  mount.tilt(0, 1) = -tilt / 9.81;
  return mount;
}

TEST(CompliantMounts, AtRestTheTiltIsThatOfTheWeightAndGravityIsMeasuredTilted) {
  MachineMotion still = rotating_sensor(0.0, 0.5);
  for (Vec3& f : still.sensors[0].force) f = Vec3(0.0, 9.81, 0.0);
  const MachineMotion compliant = with_compliant_mounts(still, {tilting_mount(0.1)});
  const Vec3 expected = 9.81 * Vec3(0.0, std::cos(0.1), std::sin(0.1));
  for (const Vec3& f : compliant.sensors[0].force) EXPECT_LT((f - expected).norm(), 1e-9);
  EXPECT_LT(compliant.sensors[0].angular_velocity.back().norm(), 1e-9);
}

TEST(CompliantMounts, InASlowRotationTheGyroscopeMeasuresTheTiltToo) {
  // The force along y is g sin(ω t): θ = −tilt sin(ω t), so θ̇ = −tilt ω cos(ω t).
  const double angular_velocity = 0.2, tilt = 0.1;
  const MachineMotion rigid = rotating_sensor(angular_velocity, 10.0),
                      compliant = with_compliant_mounts(rigid, {tilting_mount(tilt)});
  for (const std::size_t row : {400u, 1000u, 1600u})
    EXPECT_NEAR(compliant.sensors[0].angular_velocity[row].x(),
                angular_velocity * (1.0 - tilt * std::cos(angular_velocity * rigid.time[row])), 1e-3);
}

TEST(CompliantMounts, ASensorOscillatesAtItsNaturalFrequencyAfterAnImpulse) {
  MachineMotion impulse = rotating_sensor(0.0, 1.0);
  impulse.sensors[0].force[20] += Vec3(50.0, 0.0, 0.0);
  CompliantMount mount;
  mount.damping = 0.02;
  mount.frequency = 5.0;
  const MachineMotion compliant = with_compliant_mounts(impulse, {mount});
  int crossings = 0;
  for (std::size_t row = 30; row + 1 < compliant.time.size(); ++row)
    crossings += compliant.sensors[0].force[row].x() < 0.0 && compliant.sensors[0].force[row + 1].x() >= 0.0;
  EXPECT_NEAR(crossings, 5.0 * (compliant.time.back() - compliant.time[30]), 1.0);
}

TEST(CompliantMounts, PoseAndMeasuredMotionAgree) {
  const MujocoWorld world = test::world_of("excavator");
  const MachineMotion rigid = world.prescribe(test::drive_of(world.machine()), 400.0);
  std::vector<CompliantMount> mounts;
  for (std::size_t s = 0; s < rigid.sensors.size(); ++s) mounts.push_back(draw_compliant_mount(0.1, 3.0, Rng(s)));
  const MachineMotion compliant = with_compliant_mounts(rigid, mounts);
  const SensorMotion& m = compliant.sensors.back();
  double worst_rate = 0.0, worst_force = 0.0;
  for (std::size_t row = 4000; row < 12000; row += 37) {
    const double h = compliant.time[row + 1] - compliant.time[row];
    const Vec3 turned_by = quat_log(m.world_R_sensor[row - 1].conjugate() * m.world_R_sensor[row + 1]);
    worst_rate = std::max(worst_rate, (turned_by / (2.0 * h) - m.angular_velocity[row]).norm());
    const Vec3 acceleration = (m.position[row + 1] - 2.0 * m.position[row] + m.position[row - 1]) / (h * h);
    worst_force = std::max(
        worst_force, (m.world_R_sensor[row].conjugate() * (acceleration + Vec3(0.0, 0.0, 9.81)) - m.force[row]).norm());
  }
  EXPECT_LT(worst_rate, 5e-3);
  EXPECT_LT(worst_force, 0.2);
}

}  // namespace
}  // namespace kinfer
