// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/ordered_motion.hpp"

#include <gmock/gmock.h>

#include "kinfer/simulate/ground_truth.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "simulate/worlds.hpp"

namespace kinfer {
using namespace identify;
namespace {

struct Log {
  InsRecording recording;
  MachineMotion motion;
  MachineTruth truth;
};

Log log_of(const std::string& machine, const MachineOptions& options, const char* grade, const SensorFaults& trouble,
           std::uint64_t seed, Script script = Script::standard) {
  const MujocoWorld world = test::world_of(machine, options, seed);
  MachineMotion motion = world.prescribe(test::drive_of(world.machine(), {.script = script}, seed), 100.0);
  InsRecording recording =
      simulate_recording(world.machine(), motion, *sensor_grade(grade), trouble, Rng(seed).stream(1));
  MachineTruth truth = machine_truth(world.machine(), motion);
  return {std::move(recording), std::move(motion), std::move(truth)};
}

std::vector<std::string> edge_names(const OrderedMotion& o) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < o.tree.parent.size(); ++i)
    if (o.tree.parent[i]) names.push_back(o.motion.segments[*o.tree.parent[i]].name + "-" + o.motion.segments[i].name);
  return names;
}

std::vector<std::string> edge_names(const MachineTruth& truth) {
  std::vector<std::string> names;
  for (const JointTruth& joint : truth.joints) names.push_back(joint.parent + "-" + joint.child);
  return names;
}

class EverySensorFault : public testing::TestWithParam<std::tuple<std::string, int>> {};
INSTANTIATE_TEST_SUITE_P(Order, EverySensorFault,
                         testing::Combine(testing::ValuesIn(machine_names()), testing::Values(0, 1, 2, 3)));

TEST_P(EverySensorFault, LeavesTheTreeRight) {
  const auto& [machine, kind] = GetParam();
  const SensorFaults troubles[] = {
      {.has_magnetometer = false}, {.magnetic_disturbance = 15.0}, {.missing = 0.05}, {.spikes = 20.0}};
  const auto seed = static_cast<std::uint64_t>(11 + kind);
  const Base base = kind % 2 == 0 ? Base::still : Base::yawing;
  const Log log = log_of(machine, {.mounting = Mounting::arbitrary, .base = base, .slope = Angle::deg(4)}, "consumer",
                         troubles[kind], seed);
  const auto ordered = order_segments(log.recording, {}, {}, 0);
  ASSERT_TRUE(ordered) << ordered.error().what;
  EXPECT_THAT(edge_names(*ordered), testing::UnorderedElementsAreArray(edge_names(log.truth)));
}

void add_bias(TriadColumns& triad, const Vec3& bias) {
  for (int axis = 0; axis < 3; ++axis)
    for (float& value : triad.axis[static_cast<std::size_t>(axis)]) value += static_cast<float>(bias[axis]);
}

TEST(OrderedMotion, AnAccelerometerBiasThatTiltsTheVerticalIsFound) {
  Log log = log_of("excavator-general", {.mounting = Mounting::arbitrary, .base = Base::yawing}, "noise",
                   {.has_magnetometer = false}, 3);
  const double bias = 0.6;  // [m/s²] 61 mg, and so 61 mrad at most
  add_bias(log.recording.sensors[4].acceleration, {bias, 0.0, 0.0});
  const auto ordered = order_segments(log.recording, {}, {}, 0);
  ASSERT_TRUE(ordered) << ordered.error().what;
  EXPECT_THAT(edge_names(*ordered), testing::UnorderedElementsAreArray(edge_names(log.truth)));
  EXPECT_GT(ordered->tree.margin, 10.0);
  double level = 0.0;  // horizontal share of the sensor's x axis: tilts the estimated vertical
  for (const Quat& q : log.motion.sensors[4].world_R_sensor)
    level += (q * Vec3::UnitX()).head<2>().norm() / static_cast<double>(log.motion.time.size());
  EXPECT_NEAR(ordered->tree.pair(3, 4).tilt.norm(), level * bias / 9.81, 0.02);
  EXPECT_LT(ordered->tree.pair(1, 2).tilt.norm(), 0.01);
}

TEST(OrderedMotion, AGyroBiasOfFiveDegreesASecondLeavesTheHeadingRight) {
  Log log = log_of("robot6", {}, "noise", {.spikes = 20.0, .has_magnetometer = false}, 4, Script::together);
  const auto& truth = log.motion.sensors[3];
  add_bias(log.recording.sensors[3].angular_velocity, truth.world_R_sensor.front().conjugate() * Vec3(0.0, 0.0, 0.08));
  const auto ordered = order_segments(log.recording, {}, {}, 0);
  ASSERT_TRUE(ordered) << ordered.error().what;
  EXPECT_THAT(edge_names(*ordered), testing::UnorderedElementsAreArray(edge_names(log.truth)));
  const std::size_t last = truth.angular_velocity.size() - 100;
  EXPECT_LT((ordered->motion.segments[3].gyro[last] - truth.angular_velocity[last]).norm(), 0.005);
}

TEST(OrderedMotion, HeadingsAgreeWithoutMagnetometers) {
  const Log log = log_of("robot6", {.slope = Angle::deg(8)}, "noise", {.has_magnetometer = false}, 2);
  const auto ordered = order_segments(log.recording, {}, {}, 0);
  ASSERT_TRUE(ordered);
  const auto heading_error = [&](std::size_t sensor, std::size_t row) {
    const Mat3 truth = log.motion.sensors[sensor].world_R_sensor[row].toRotationMatrix();
    const Mat3 turn = ordered->motion.segments[sensor].rotation[row] * truth.transpose();
    return std::atan2(turn(1, 0), turn(0, 0));
  };
  for (const std::size_t row : {1000u, 2500u, 4000u})
    for (std::size_t sensor = 2; sensor < 7; ++sensor)
      EXPECT_NEAR(std::remainder(heading_error(sensor, row) - heading_error(1, row), 6.283185307), 0.0, 0.02)
          << sensor << " at " << row;
}

TEST(OrderedMotion, IsTheSameForAnyNumberOfThreads) {
  const Log log = log_of("tree", {}, "industrial", {}, 5);
  const auto one = order_segments(log.recording, {}, {}, 1);
  for (const int threads : {2, 7}) {
    const auto many = order_segments(log.recording, {}, {}, threads);
    ASSERT_EQ(one->tree.pairs.size(), many->tree.pairs.size());
    for (std::size_t i = 0; i < one->tree.pairs.size(); ++i) {
      EXPECT_EQ(one->tree.pairs[i].distance, many->tree.pairs[i].distance);
      EXPECT_EQ(one->tree.pairs[i].heading.angle, many->tree.pairs[i].heading.angle);
    }
  }
}

TEST(OrderedMotion, ReportsThatTwoSensorsAreStationary) {
  Log log = log_of("crane", {}, "noise", {}, 1);
  log.recording.sensors.push_back(log.recording.sensors.front());
  log.recording.sensors.back().name = "other";
  const auto ordered = order_segments(log.recording, {}, {}, 0);
  ASSERT_FALSE(ordered);
  EXPECT_THAT(ordered.error().what, testing::HasSubstr("each machine a log of its own"));
}

}  // namespace
}  // namespace kinfer
