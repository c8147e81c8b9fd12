// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/refine.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "identify/driven_machine.hpp"
#include "kinfer/identify/findings/unobservable.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/simulate/ground_truth.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "repeats.hpp"
#include "simulate/worlds.hpp"

namespace kinfer {
using namespace identify;
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Field;

using RefinedDrive = test::DrivenMachine;

/// The base and the first joints: for what does not depend on how many joints there are.
RefinedDrive three_joints(RefinedDrive whole) {
  return test::first_sensors(std::move(whole), 4);
}

RefinedDrive driven(const std::string& name, const MachineOptions& options, const SensorModel& grade,
                    const SensorFaults& trouble = {}) {
  const MujocoWorld world = test::world_of(name, options, 5);
  const MachineMotion motion = world.prescribe(test::drive_of(world.machine(), {}, 5), 100.0);
  return {simulate_recording(world.machine(), motion, grade, trouble, Rng(5)), machine_truth(world.machine(), motion)};
}

RefinedDrive driven(const std::string& name, const MachineOptions& options, const char* grade,
                    const SensorFaults& trouble = {}) {
  return driven(name, options, *sensor_grade(grade), trouble);
}

Refinement refined(const RefinedDrive& drive, int threads = 0) {
  const auto ordered = order_segments(drive.recording, {}, drive.truth.root, threads);
  EXPECT_TRUE(ordered);
  std::vector<InitialJoint> starts;
  for (std::size_t i = 1; i < ordered->tree.order.size(); ++i) {
    const std::size_t child = ordered->tree.order[i];
    const auto truth = std::ranges::find(drive.truth.joints, ordered->motion.segments[child].name, &JointTruth::child);
    starts.push_back(estimate_initial_joint(
        ordered->motion, ordered->tree, *ordered->tree.parent[child], child,
        truth->type == JointType::prismatic ? EstimatedJointType::prismatic : EstimatedJointType::revolute));
  }
  auto result = refine(drive.recording, ordered->motion, ordered->tree, starts, {.fit = {.threads = threads}});
  EXPECT_TRUE(result);
  return *result;
}

/// Distance from the true axis line in the child's sensor, without unobservable directions [m].
double distance_of_lines(const JointEstimate& found, const JointTruth& truth) {
  Vec3 error = found.point_in_child - truth.point_in_child;
  std::vector<Vec3> free{truth.axis_in_child};
  for (const Vec3& hidden : truth.unobservable_in_child)
    if (hidden.cross(free.front()).norm() > 1e-3) free.push_back(hidden);
  for (const Vec3& direction : free) error -= direction * direction.dot(error);
  return error.norm();
}

double axis_error(const JointEstimate& found, const JointTruth& truth) {
  return std::asin(std::min(1.0, found.axis_in_child.cross(truth.axis_in_child).norm()));
}

void expect_close(const Refinement& found, const MachineTruth& truth, double line, double direction) {
  for (const RefinedJoint& joint : found.joints) {
    const auto t = std::ranges::find(truth.joints, joint.estimate.child, &JointTruth::child);
    ASSERT_NE(t, truth.joints.end());
    EXPECT_EQ(joint.estimate.parent, t->parent);
    EXPECT_LT(axis_error(joint.estimate, *t), direction) << t->name;
    if (t->type == JointType::revolute) {
      EXPECT_LT(distance_of_lines(joint.estimate, *t), line) << t->name;
    }
  }
}

TEST(Refine, IdentifiesASimulatedMachineAsAccuratelyAsItsSensorsAllow) {
  for (const char* name : test::repeats({"excavator-general", "crane", "robot6", "tree"})) {
    const RefinedDrive drive = driven(name, {.mounting = Mounting::arbitrary}, "industrial");
    expect_close(refined(drive), drive.truth, 5e-3, 3e-3);
  }
}

TEST(Refine, SensorsWithoutNoiseAreNoExceptions) {
  const RefinedDrive drive =
      three_joints(driven("excavator-general", {.mounting = Mounting::arbitrary}, SensorModel{}));
  const Refinement found = refined(drive);
  expect_close(found, drive.truth, 0.1e-3, 0.1e-3);
  for (const RefinedJoint& joint : found.joints) EXPECT_GT(std::ranges::min(joint.estimate.sd.axis_in_child), 0.0);
  EXPECT_FALSE(found.tracking.sensors.empty());
}

TEST(Refine, NeedsNoStationaryBase) {
  const RefinedDrive drive = driven("excavator-general", {.base = Base::yawing}, "industrial");
  const Refinement found = refined(drive);
  expect_close(found, drive.truth, 10e-3, 3e-3);
  EXPECT_TRUE(found.joints.front().estimate.unobservable_in_parent.empty());
}

/// The axes that start on a body with one fixed axis: their direction in that body is known by the azimuth alone.
void expect_azimuths(const Refinement& found, const MachineTruth& truth, double limit) {
  int limbs = 0;
  for (const RefinedJoint& joint : found.joints) {
    const JointEstimate& estimate = joint.estimate;
    const auto t = std::ranges::find(truth.joints, estimate.child, &JointTruth::child);
    if (t->unobservable_in_parent.size() != 1) continue;
    ++limbs;
    const double error = std::asin(std::min(1.0, estimate.axis_in_parent.cross(t->axis_in_parent).norm()));
    EXPECT_LT(error, limit) << t->name;
    EXPECT_LT(error, 4.0 * std::hypot(estimate.sd.axis_in_parent[0], estimate.sd.axis_in_parent[1])) << t->name;
  }
  EXPECT_GT(limbs, 0);
}

TEST(Refine, MagnetometersTellTheAzimuthOfEveryLimb) {
  const RefinedDrive sound = driven("tree", {.mounting = Mounting::arbitrary}, "industrial");
  expect_azimuths(refined(sound), sound.truth, 15e-3);
  const RefinedDrive iron = driven("tree", {.mounting = Mounting::arbitrary}, "industrial",
                                   {.hard_iron = 4.0, .soft_iron = 0.04, .magnetic_transients = 10.0});
  const Refinement found = refined(iron);
  expect_azimuths(found, iron.truth, 60e-3);
  expect_close(found, iron.truth, 5e-3, 3e-3);
}

TEST(Refine, ASlopeTellsTheAzimuthWithoutMagnetometers) {
  const RefinedDrive drive =
      driven("excavator-general", {.slope = Angle::deg(3)}, "industrial", {.has_magnetometer = false});
  expect_azimuths(refined(drive), drive.truth, 40e-3);
}

TEST(Refine, ClippedSamplesAreBounds) {
  SensorModel gyroscope = *sensor_grade("industrial"), accelerometer = gyroscope;
  gyroscope.gyroscope.range = 0.4;
  accelerometer.accelerometer.range = 1.3 * 9.80665;
  for (const SensorModel& grade : {gyroscope, accelerometer}) {
    const RefinedDrive drive = driven("excavator-general", {}, grade);
    std::size_t clipped = 0;
    for (const InsSensor& sensor : drive.recording.sensors)
      clipped += count(sensor, angular_velocity_clipped) + count(sensor, acceleration_clipped);
    EXPECT_GT(clipped, 200u);
    expect_close(refined(drive), drive.truth, 5e-3, 3e-3);
  }
}

TEST(Refine, HandlesFaultyRecordings) {
  const RefinedDrive drive =
      driven("excavator-general", {}, "industrial", {.missing = 0.05, .spikes = 6.0, .has_magnetometer = false});
  expect_close(refined(drive), drive.truth, 5e-3,
               25e-3);  // without magnetometer the swing's heading is poorly observable
}

TEST(Refine, ReportsWhatAStationaryPlatformLeavesUnobservable) {
  const RefinedDrive drive = driven("excavator", {}, "noise", {.has_magnetometer = false});
  const Refinement found = refined(drive);
  std::vector<JointEstimate> joints;
  for (const RefinedJoint& joint : found.joints) joints.push_back(joint.estimate);
  list_unobservable(joints);
  EXPECT_EQ(joints[0].unobservable_in_parent.size(), 3u);
  EXPECT_THAT(joints[0].unobservable, Contains(AllOf(Field(&Unobservable::kind, UnobservableKind::point),
                                                     Field(&Unobservable::sensor, "ins0"))));
  EXPECT_TRUE(joints[0].azimuth_unobservable);
  EXPECT_THAT(joints[0].unobservable, Contains(Field(&Unobservable::kind, UnobservableKind::azimuth)));
  EXPECT_THAT(joints[1].unobservable, Contains(Field(&Unobservable::kind, UnobservableKind::place_about_axis)));
  // The circle on which the joint is, about the swing's axis, is as wide as its uncertainty.
  const Vec3 swing = joints[0].axis_in_child, arm = joints[1].point_in_parent - joints[0].point_in_child;
  const double radius = (arm - swing * swing.dot(arm)).norm();
  const auto& sd = joints[1].sd.point_in_parent;
  const Vec3 across = joints[1].axis_in_parent.cross(swing).normalized();
  EXPECT_GT(std::hypot(sd[0], sd[1]), std::abs(across.dot(arm)));
  EXPECT_GT(*std::ranges::max_element(joints[1].sd.axis_in_parent), 0.7);
  EXPECT_GT(radius, 0.0);
  ASSERT_EQ(joints[1].unobservable_in_parent.size(), 1u);
  EXPECT_LT(angle_between(joints[0].axis_in_child, joints[1].unobservable_in_parent[0]) *
                angle_between(joints[0].axis_in_child, Vec3(-joints[1].unobservable_in_parent[0])),
            0.05);
  EXPECT_THAT(joints[2].unobservable, Contains(Field(&Unobservable::kind, UnobservableKind::offset_split)));
}

TEST(Refine, GivesTheSameBitsForAnyNumberOfThreads) {
  const RefinedDrive drive = three_joints(driven("excavator", {}, "noise"));
  const Refinement one = refined(drive, 1);
  for (const int threads : {2, 7}) {
    const Refinement many = refined(drive, threads);
    for (std::size_t i = 0; i < one.joints.size(); ++i) {
      EXPECT_EQ(one.joints[i].estimate.point_in_child, many.joints[i].estimate.point_in_child);
      EXPECT_EQ(one.joints[i].estimate.sd.point_in_child, many.joints[i].estimate.sd.point_in_child);
    }
  }
}

}  // namespace
}  // namespace kinfer
