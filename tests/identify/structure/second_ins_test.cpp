// SPDX-License-Identifier: Apache-2.0
// Two INS on one segment: as in paper 1, the second one is used, not refused.
#include <gtest/gtest.h>

#include <algorithm>

#include "kinfer/identify/pipeline.hpp"
#include "kinfer/measurement/ins/ins_selection.hpp"
#include "kinfer/simulate/ground_truth.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/prescribed_motion.hpp"
#include "simulate/worlds.hpp"

namespace kinfer {
using namespace identify;
namespace {

constexpr std::size_t boom = 2;

/// The machine with its boom's INS at another place on the boom.
Machine with_other_boom_sensor(Machine machine) {
  MountedSensor& sensor = machine.sensors[boom];
  sensor.name = "second";
  sensor.segment_T_sensor.position += Vec3(0.3, -0.1, 0.2);
  sensor.segment_T_sensor.rotation = sensor.segment_T_sensor.rotation * exp_so3({0.3, -0.2, 0.5});
  return machine;
}

TEST(SecondIns, OnOneSegmentIsFoundRigidAndTheOtherJointsStayRight) {
  const MujocoWorld world = test::world_of("excavator-general", {}, 5);
  const Machine first = world.machine(), other = with_other_boom_sensor(first);
  const Drive drive = test::drive_of(first, {.script = Script::together});
  const MachineMotion motion = prescribed_motion(first, drive, 100.0),
                      other_motion = prescribed_motion(other, drive, 100.0);
  const SensorModel grade = *sensor_grade("noise");
  InsRecording recording = select_sensors(simulate_recording(first, motion, grade, {}, Rng(1)), {0, 1, 2, 3});
  recording.sensors.push_back(simulate_recording(other, other_motion, grade, {}, Rng(2)).sensors[boom]);
  std::vector<JointTruth> truth = machine_truth(first, motion).joints;
  std::ranges::copy(machine_truth(other, other_motion).joints, std::back_inserter(truth));

  const auto found = identify_machine(recording, {.root = "ins0"}, Rng(1));
  ASSERT_TRUE(found) << found.error().what;
  ASSERT_EQ(found->joints.size(), 4U);
  int rigid = 0;
  for (const JointEstimate& joint : found->joints) {
    if (joint.type == EstimatedJointType::rigid) {
      ++rigid;
      const bool between_them =
          (joint.parent == "ins2" && joint.child == "second") || (joint.parent == "second" && joint.child == "ins2");
      EXPECT_TRUE(between_them) << joint.parent << "-" << joint.child;
      continue;
    }
    const auto is_it = [&](const JointTruth& t) { return t.parent == joint.parent && t.child == joint.child; };
    const auto t = std::ranges::find_if(truth, is_it);
    ASSERT_NE(t, truth.end()) << joint.parent << "-" << joint.child;
    EXPECT_LT(joint.axis_in_child.cross(t->axis_in_child).norm(), 3e-3) << joint.child;
    EXPECT_LT((joint.point_in_child - t->point_in_child).cross(t->axis_in_child).norm(), 5e-3) << joint.child;
  }
  EXPECT_EQ(rigid, 1);
}

}  // namespace
}  // namespace kinfer
