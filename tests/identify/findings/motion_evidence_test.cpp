// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/motion_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "identify/measured_segments.hpp"
#include "kinfer/identify/findings/advice.hpp"
#include "kinfer/identify/geometry/identified_chain.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::freely_moving;
using test::measured_segment;
using test::three_signals;

JointGeometry hinge_geometry() {
  return fit_revolute_geometry(test::general_hinge(), {{{-0.6}, {0}, {0}}, {{0.1}, {0}, {0}}, {{0.9}, {0}, {0}}});
}

/// Three segments in series with the true chain.
struct PredictedMachine {
  RecordedMotion motion = test::serial_machine(freely_moving(), 3, test::general_hinge());
  Identification found;

  PredictedMachine() {
    found.root = "a";
    for (const auto& [parent, child] : {std::pair{"a", "b"}, {"b", "c"}}) {
      const GeometryEstimate exact{hinge_geometry(), {}};
      found.joints.push_back(joint_estimate(parent, child, exact));
      for (const DhRowEstimate& row : canonical_dh_rows(found.joints.back(), exact)) found.dh.push_back(row);
    }
    found.chain = build_chain("a", found.joints, found.dh, Mat3::Identity());
  }
  MotionEvidence evidence(const HeldOut& held = {}) const { return motion_evidence(motion, found, held); }
};

const Trace& trace(const MotionEvidence& evidence, const std::string& sensor, TraceQuantity quantity) {
  for (const Trace& t : evidence.traces)
    if (t.sensor == sensor && t.quantity == quantity) return t;
  ADD_FAILURE() << sensor;
  return evidence.traces.front();
}

TEST(MotionEvidence, ATrueChainPredictsEverySensorExactly) {
  const MotionEvidence evidence = PredictedMachine().evidence();
  ASSERT_EQ(evidence.traces.size(), 4U) << "two quantities of two sensors";
  for (const Trace& t : evidence.traces) {
    EXPECT_LT(t.rms_fitted, 1e-6) << t.sensor;
    EXPECT_EQ(t.rms_holdout, 0.0) << "no rows were held out";
    EXPECT_GT(t.rms_measured, 0.3) << t.sensor;
  }
}

TEST(MotionEvidence, AWrongLeverCostsWhatItAcceleratesInAllSensorsBehind) {
  PredictedMachine machine;
  const Vec3 error(0.1, 0.0, 0.0);
  machine.found.joints[0].point_in_parent += error;
  double square = 0.0;
  const SegmentMotion& a = machine.motion.segments[0];
  for (std::size_t row = 0; row < machine.motion.rows(); ++row) {
    const Vec3 arm = a.rotation[row] * error;
    square +=
        (a.angular_acceleration[row].cross(arm) + a.angular_velocity[row].cross(a.angular_velocity[row].cross(arm)))
            .squaredNorm();
  }
  const double expected = std::sqrt(square / static_cast<double>(machine.motion.rows()));
  const MotionEvidence evidence = machine.evidence();
  for (const char* sensor : {"b", "c"})
    EXPECT_NEAR(trace(evidence, sensor, TraceQuantity::acceleration).rms_fitted, expected, 1e-6) << sensor;
  EXPECT_LT(trace(evidence, "b", TraceQuantity::angular_velocity).rms_fitted, 1e-9);
}

TEST(MotionEvidence, AWrongAxisCostsTheRateAcrossIt) {
  PredictedMachine machine;
  const Vec3 axis = machine.found.joints[0].axis_in_parent;
  machine.found.joints[0].axis_in_parent = exp_so3(0.1 * any_perpendicular(axis)) * axis;
  double square = 0.0;
  for (const double rate : three_signals()[0].angular_velocity) square += rate * rate / 600.0;
  EXPECT_NEAR(trace(machine.evidence(), "b", TraceQuantity::angular_velocity).rms_fitted,
              std::sin(0.1) * std::sqrt(square), 1e-6);
}

TEST(MotionEvidence, HeldOutWindowsAreThoseOfTheChainFittedWithoutThem) {
  PredictedMachine machine;
  HeldOut held{.windows = {{1.0, 2.0}, {4.0, 4.5}}, .joints = machine.found.joints};
  held.joints[0].point_in_parent += Vec3(0.1, 0.0, 0.0);
  const MotionEvidence evidence = machine.evidence(held);
  const Trace& t = trace(evidence, "b", TraceQuantity::acceleration);
  EXPECT_LT(t.rms_fitted, 1e-6);
  EXPECT_GT(t.rms_holdout, 0.02);
  EXPECT_EQ(evidence.held_out.size(), 2U);
}

TEST(MotionEvidence, UnusableRowsAreGaps) {
  PredictedMachine machine;
  for (std::size_t row = 0; row < 100; ++row) {
    machine.motion.usable[row] = false;
    machine.motion.segments[1].acceleration[row] = Vec3(1e3, 1e3, 1e3);
  }
  const MotionEvidence evidence = machine.evidence();
  const Trace& t = trace(evidence, "b", TraceQuantity::acceleration);
  EXPECT_LT(t.rms_fitted, 1e-6);
  EXPECT_TRUE(std::isnan(t.measured[0].low.front()));
  EXPECT_FALSE(std::isnan(t.measured[0].low.back()));
  EXPECT_EQ(evidence.time.size(), t.measured[0].low.size());
}

TEST(MotionEvidence, TheTrajectoryOfASearchedJointIsItsAngle) {
  const PredictedMachine machine;
  const MachineTrajectory trajectory = machine.evidence().trajectory;
  ASSERT_EQ(trajectory.q.rows(), 2);
  ASSERT_EQ(trajectory.q.cols(), 600);
  EXPECT_EQ(trajectory.root.size(), 600U);
  for (const Eigen::Index row : {0, 150, 599}) {
    const auto at = static_cast<std::size_t>(row);
    EXPECT_NEAR(trajectory.q(0, row), three_signals()[0].angle[at], 1e-6);
    EXPECT_NEAR(trajectory.q(1, row), three_signals()[1].angle[at], 1e-6);
    const Quat r(trajectory.root[at][0], trajectory.root[at][1], trajectory.root[at][2], trajectory.root[at][3]);
    EXPECT_LT((r.toRotationMatrix() - machine.motion.segments[0].rotation[at]).norm(), 1e-9);
  }
}

TEST(MotionEvidence, TheTrajectoryOfARefinedJointIsThatOfTheFitAndAStationaryRootHasOneOrientation) {
  PredictedMachine machine;
  machine.motion.segments[0].still = true;
  machine.found.joints[0].trajectory = MatrixXd::Constant(1, 600, 0.25);
  const MachineTrajectory trajectory = machine.evidence().trajectory;
  EXPECT_EQ(trajectory.root.size(), 1U);
  EXPECT_EQ(trajectory.q(0, 300), 0.25);
  EXPECT_NEAR(trajectory.q(1, 300), three_signals()[1].angle[300], 1e-6);
}

/// Predictions of the child behind a joint of this type, whose geometry is exact.
MotionEvidence evidence_of_type(EstimatedJointType type, const std::vector<FrameState>& child, const Vec3& in_parent,
                                const Vec3& in_child, const Vec3& axis = Vec3::UnitZ()) {
  const RecordedMotion motion =
      test::recorded_motion({measured_segment("a", freely_moving()), measured_segment("b", child)});
  Identification found;
  found.root = "a";
  found.joints = {{.parent = "a", .child = "b", .type = type}};
  found.joints[0].axis_in_parent = axis;
  found.joints[0].point_in_parent = in_parent;
  found.joints[0].point_in_child = in_child;
  found.chain.joints = {};
  return motion_evidence(motion, found);
}

TEST(MotionEvidence, AJointWithSeveralAxesIsCompatibleWithAnyRotation) {
  const DhLeaf mount{.theta = 0.7, .d = 0.2, .alpha = -1.1, .a = 0.5}, end{.theta = -1.9, .d = 0.15, .a = 0.3};
  const std::vector<DhLeaf> leaves{mount, {.alpha = 1.4, .theta_signal = 0}, {.theta_signal = 1}, end};
  const auto child = propagate(freely_moving(), leaves, three_signals());
  for (const EstimatedJointType type : {EstimatedJointType::universal, EstimatedJointType::spherical})
    for (const Trace& t :
         evidence_of_type(type, child, transform(mount).position, transform(end).inverse().position).traces)
      EXPECT_LT(t.rms_fitted, 1e-6) << name(type) << " " << name(t.quantity);
  const MotionEvidence rigid =
      evidence_of_type(EstimatedJointType::rigid, child, transform(mount).position, transform(end).inverse().position);
  EXPECT_GT(trace(rigid, "b", TraceQuantity::angular_velocity).rms_fitted, 1.0) << "a rigid one is not";
}

TEST(MotionEvidence, APrismaticJointIsCompatibleWithAnyMotionAlongItsAxis) {
  const auto parent = freely_moving();
  auto child = parent;
  const Vec3 axis = Vec3(0.6, 0.0, 0.8);
  for (std::size_t row = 0; row < child.size(); ++row)
    child[row].acceleration += child[row].rotation * axis * std::sin(0.1 * static_cast<double>(row));
  const MotionEvidence along = evidence_of_type(EstimatedJointType::prismatic, child, Vec3::Zero(), Vec3::Zero(), axis),
                       across = evidence_of_type(EstimatedJointType::prismatic, child, Vec3::Zero(), Vec3::Zero(),
                                                 Vec3::UnitY());
  EXPECT_LT(trace(along, "b", TraceQuantity::acceleration).rms_fitted, 1e-9);
  EXPECT_NEAR(trace(across, "b", TraceQuantity::acceleration).rms_fitted, std::sqrt(0.5), 0.05);
}

TEST(Advice, EveryEndSegmentAndEveryJointThatWasNotMovedGetsItsOwn) {
  Identification result;
  result.joints = {{.parent = "a", .child = "b"},
                   {.parent = "b", .child = "c", .type = EstimatedJointType::rigid},
                   {.parent = "b", .child = "d"}};
  std::vector<std::string> list;
  for (const IdentificationAdvice& advice : identification_advice(result)) {
    std::string text(name(advice.kind));
    if (advice.values.has("sensor")) text += " " + advice.values.text("sensor");
    if (advice.values.has("child")) text += " " + advice.values.text("child");
    list.push_back(text);
  }
  EXPECT_EQ(list, (std::vector<std::string>{"use_chain", "move_joint c", "measure_tool c", "measure_tool d"}));
}

}  // namespace
}  // namespace kinfer
