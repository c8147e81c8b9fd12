// SPDX-License-Identifier: Apache-2.0
// Sensors that are silent for a while, begin late or end early.
#include <gmock/gmock.h>

#include "identify/driven_machine.hpp"
#include "kinfer/identify/structure/joint_type.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::DrivenMachine;
using test::identified;
using test::worst_line_error;

void silence(InsRecording& recording, std::size_t sensor, double begin, double end) {
  const std::vector<double>& time = recording.loggers[recording.sensors[sensor].logger].time;
  for (std::size_t row = 0; row < time.size(); ++row)
    if (time[row] >= begin && time[row] < end)
      recording.sensors[sensor].faults[row] = acceleration_missing | angular_velocity_missing | field_missing;
}

std::vector<std::string> edges_of(const OrderedMotion& o) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < o.tree.parent.size(); ++i)
    if (o.tree.parent[i]) names.push_back(o.motion.segments[*o.tree.parent[i]].name + "-" + o.motion.segments[i].name);
  return names;
}

std::vector<std::string> edges_of(const MachineTruth& truth) {
  std::vector<std::string> names;
  for (const JointTruth& joint : truth.joints) names.push_back(joint.parent + "-" + joint.child);
  return names;
}

TEST(Gaps, OfSecondsInOneSensorChangeNeitherOrderNorTypes) {
  DrivenMachine drive = test::driven_machine("excavator-general", 5);
  for (double begin = 5.0; begin < 50.0; begin += 3.0) silence(drive.recording, 2, begin, begin + 1.5);
  const auto ordered = order_segments(drive.recording, {}, {}, 0);
  ASSERT_TRUE(ordered) << ordered.error().what;
  EXPECT_THAT(edges_of(*ordered), testing::UnorderedElementsAreArray(edges_of(drive.truth)));
  EXPECT_GT(ordered->tree.margin, 2.0);
  for (const JointTypeEvidence& joint : identify::joint_types(ordered->motion, ordered->tree))
    EXPECT_EQ(joint.type, EstimatedJointType::revolute);
}

TEST(Gaps, SensorsThatBeginLateOrEndEarlyAreFittedAllTheSame) {
  DrivenMachine drive = test::driven_arm(5, 5);
  silence(drive.recording, 4, 0.0, 12.0);
  silence(drive.recording, 3, 25.0, 100.0);
  const Identification found = identified(drive.recording);
  EXPECT_TRUE(found.tracking) << "the fit has a covariance";
  EXPECT_LT(worst_line_error(found.joints, drive.truth), 6e-3);
}

}  // namespace
}  // namespace kinfer
