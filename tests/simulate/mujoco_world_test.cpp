// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "kinfer/simulate/prescribed_motion.hpp"
#include "simulate/worlds.hpp"

namespace kinfer {
namespace {

using test::drive_of;
using test::driven;
using test::world_of;

struct Place {
  std::string machine;
  MachineOptions options;
};

std::vector<Place> places() {
  std::vector<Place> all;
  for (const std::string& name : machine_names())
    for (const Base base : {Base::still, Base::rocking, Base::yawing})
      all.push_back({name, {.base = base, .slope = base == Base::rocking ? Angle::deg(7) : Angle{}}});
  return all;
}

class EveryMachine : public ::testing::TestWithParam<Place> {};
INSTANTIATE_TEST_SUITE_P(on, EveryMachine, ::testing::ValuesIn(places()), [](const auto& instance) {
  std::string name = instance.param.machine + (instance.param.options.base == Base::still     ? "_still"
                                               : instance.param.options.base == Base::rocking ? "_rocking"
                                                                                              : "_yawing");
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST_P(EveryMachine, MujocosInverseDynamicsAndOwnKinematicsAgree) {
  const MujocoWorld world = world_of(GetParam().machine, GetParam().options, 5);
  const Drive drive = drive_of(world.machine(), {.duration = 30.0});
  const MachineMotion theirs = world.prescribe(drive, 50.0), ours = prescribed_motion(world.machine(), drive, 50.0);
  ASSERT_EQ(theirs.time.size(), 1500u);
  for (std::size_t s = 0; s < ours.sensors.size(); ++s)
    for (std::size_t row = 0; row < ours.time.size(); ++row) {
      const SensorMotion &a = ours.sensors[s], &b = theirs.sensors[s];
      ASSERT_LT((a.force[row] - b.force[row]).norm(), 1e-8) << s << " " << row;
      ASSERT_LT((a.angular_velocity[row] - b.angular_velocity[row]).norm(), 1e-8) << s << " " << row;
      ASSERT_LT((a.field[row] - b.field[row]).norm(), 1e-8) << s << " " << row;
      ASSERT_LT((a.position[row] - b.position[row]).norm(), 1e-8) << s << " " << row;
      ASSERT_LT(a.world_R_sensor[row].angularDistance(b.world_R_sensor[row]), 1e-7) << s << " " << row;  // acos near 1
    }
}

TEST_P(EveryMachine, ASensorAtRestMeasuresGUpward) {
  const MujocoWorld world = world_of(GetParam().machine, GetParam().options);
  Drive drive = drive_of(world.machine());
  drive.duration = 3.0;  // within the first rest
  const MachineMotion motion = driven(world, drive, 50.0);
  for (const SensorMotion& sensor : motion.sensors)
    for (std::size_t row = 0; row < motion.time.size(); ++row) {
      ASSERT_LT((sensor.world_R_sensor[row] * sensor.force[row] - Vec3(0, 0, 9.81)).norm(), 1e-9);
      ASSERT_LT(sensor.angular_velocity[row].norm(), 1e-9);
    }
}

/// Fourth-order differences over five rows; h: between rows.
template <class Column>
Vec3 first_derivative(const Column& at, double h) {
  return (at(-2) - 8.0 * at(-1) + 8.0 * at(1) - at(2)) / (12.0 * h);
}
template <class Column>
Vec3 second_derivative(const Column& at, double h) {
  return (-at(-2) + 16.0 * at(-1) - 30.0 * at(0) + 16.0 * at(1) - at(2)) / (12.0 * h * h);
}

// Differences have an error of h⁴/90 of the sixth derivative, the integrator a similar one; both are far smaller at 500
// Hz.
constexpr double rate_tolerance = 1e-6;   // [rad/s]
constexpr double force_tolerance = 1e-4;  // [m/s²]

class EitherServo : public ::testing::TestWithParam<Servo> {};
INSTANTIATE_TEST_SUITE_P(holds, EitherServo, ::testing::Values(Servo::stiff, Servo::soft));

TEST_P(EitherServo, GyroIsTheDerivativeOfOrientationAndForceThatOfPositionAndGravity) {
  const MujocoWorld world = world_of("excavator-general", {.base = Base::rocking});
  const Drive drive = drive_of(world.machine(), {.duration = 16.0});
  constexpr double sampling_rate = 500.0;
  const MachineMotion motion = driven(world, drive, sampling_rate, GetParam());
  double worst_rate = 0.0, worst_force = 0.0, moved = 0.0;
  for (const SensorMotion& sensor : motion.sensors)
    for (std::size_t row = 2; row + 2 < motion.time.size(); ++row) {
      const auto turned = [&](int k) {
        return quat_log(sensor.world_R_sensor[row].conjugate() * sensor.world_R_sensor[row + k]);
      };
      const auto place = [&](int k) { return sensor.position[row + k]; };
      const Vec3 felt = sensor.world_R_sensor[row] * sensor.force[row] - Vec3(0, 0, 9.81);
      worst_rate =
          std::max(worst_rate, (first_derivative(turned, 1.0 / sampling_rate) - sensor.angular_velocity[row]).norm());
      worst_force = std::max(worst_force, (second_derivative(place, 1.0 / sampling_rate) - felt).norm());
      moved = std::max(moved, felt.norm());
    }
  EXPECT_LT(worst_rate, rate_tolerance);
  EXPECT_LT(worst_force, force_tolerance);
  EXPECT_GT(moved, 3.0);  // [m/s²] the force varies enough to test
}

TEST(World, StiffJointsFollowTheirDriveAndSoftOnesDeviateWhenOthersMove) {
  const MujocoWorld world = world_of("excavator");
  const Drive drive = drive_of(world.machine(), {.script = Script::sequential, .duration = 20.0});
  const auto deviation = [&](Servo servo) {
    const MachineMotion motion = driven(world, drive, 100.0, servo);
    double worst = 0.0;
    for (std::size_t row = 0; row < motion.time.size(); ++row)
      for (std::size_t k = 0; k < drive.joints.size(); ++k)
        worst = std::max(worst, std::abs(motion.q(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(row)) -
                                         state_at(drive.joints[k], motion.time[row]).q));
    return worst;
  };
  EXPECT_LT(deviation(Servo::stiff), 1e-7);
  EXPECT_GT(deviation(Servo::soft), 1e-2);
}

using Mat4 = Eigen::Matrix4d;

/// Paper 1, eq. (1): RotZ(theta) TransZ(d) TransX(a) RotX(alpha), written out.
Mat4 dh(double theta, double d, double alpha, double a) {
  const double ct = std::cos(theta), st = std::sin(theta), ca = std::cos(alpha), sa = std::sin(alpha);
  Mat4 m;
  // clang-format off
  m << ct, -ca * st,  sa * st, a * ct,
       st,  ca * ct, -sa * ct, a * st,
        0,       sa,       ca,      d,
        0,        0,        0,      1;
  // clang-format on
  return m;
}

TEST(World, ExcavatorIsTheChainOfThePapersEquation27) {
  const MujocoWorld world = world_of("excavator");
  const MachineMotion motion = driven(world, drive_of(world.machine(), {.duration = 25.0}), 20.0);
  constexpr double pi = std::numbers::pi;
  for (std::size_t row = 0; row < motion.time.size(); ++row) {
    const VectorXd q = motion.q.col(static_cast<Eigen::Index>(row));
    std::array<Mat4, 6> ins;
    ins[0] = Mat4::Identity();
    ins[0](2, 3) = 1.1;  // height of the platform's INS
    ins[1] = ins[0] * dh(q[0], 0, 0, -1.25);
    ins[2] = ins[1] * dh(pi, 0, -pi / 2, -0.4) * dh(q[1], 0, 0, 0.58);
    ins[3] = ins[2] * dh(0, 0, 0, 1.285) * dh(q[2], 0, 0, 0.33);
    ins[4] = ins[3] * dh(0, 0, 0, 1.62) * dh(q[3], 0, 0, 0.75);
    ins[5] = ins[4] * dh(0, 0, 0, 1.45) * dh(q[4], 0, 0, 0.42);
    for (std::size_t s = 0; s < ins.size(); ++s) {
      ASSERT_LT((motion.sensors[s].position[row] - ins[s].topRightCorner<3, 1>()).norm(), 1e-12);
      ASSERT_LT((motion.sensors[s].world_R_sensor[row].toRotationMatrix() - ins[s].topLeftCorner<3, 3>()).norm(),
                1e-12);
    }
  }
}

TEST(World, StandardDriveMovesTheToolWith10To15MPerS2) {
  const MujocoWorld world = world_of("excavator");
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const MachineMotion motion = prescribed_motion(world.machine(), drive_of(world.machine(), {}, seed), 50.0);
    double peak = 0.0;
    const SensorMotion& tool = motion.sensors.back();
    for (std::size_t row = 0; row < motion.time.size(); ++row)
      peak = std::max(peak, (tool.world_R_sensor[row] * tool.force[row] - Vec3(0, 0, 9.81)).norm());
    EXPECT_GT(peak, 10.0) << seed;
    EXPECT_LT(peak, 15.0) << seed;
  }
}

TEST(World, SameSeedMakesTheSameMotionBitForBit) {
  const auto make = [](std::uint64_t seed) {
    const MujocoWorld world = world_of("excavator-general", {}, seed);
    return driven(world, drive_of(world.machine(), {.duration = 18.0}, seed), 50.0);
  };
  const MachineMotion once = make(3), again = make(3), other = make(4);
  EXPECT_TRUE(once.q == again.q);
  for (std::size_t s = 0; s < once.sensors.size(); ++s) EXPECT_TRUE(once.sensors[s].force == again.sensors[s].force);
  EXPECT_FALSE(once.q == other.q);
}

TEST(World, AFileThatIsNoMachineIsRefusedWithMujocosMessage) {
  const auto world = MujocoWorld::load("<mujoco><worldbody><body><geom size='x'/></body></worldbody></mujoco>");
  ASSERT_FALSE(world);
  EXPECT_NE(world.error().what.find("machine.xml: "), std::string::npos) << world.error().what;
}

TEST(World, AnUnknownMachineIsRefusedWithTheKnownOnes) {
  const auto mjcf = machine_mjcf("excavater", {}, Rng(1));
  ASSERT_FALSE(mjcf);
  EXPECT_EQ(mjcf.error().what,
            "excavater: no such machine; known are crane, excavator, excavator-general, robot6, tree");
}

}  // namespace
}  // namespace kinfer
