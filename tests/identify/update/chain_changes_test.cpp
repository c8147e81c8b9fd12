// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/update/chain_changes.hpp"

#include <gtest/gtest.h>

#include "identify/update/known_model.hpp"
#include "kinfer/evidence/tracking/body_poses.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;

VectorXd some_positions(const TrackingModel& model, Rng& rng) {
  VectorXd q(model.positions());
  for (double& value : q) value = rng.uniform(-1.0, 1.0);
  return q;
}

double distance(const Pose& a, const Pose& b) {
  return (a.position - b.position).norm() + (a.rotation - b.rotation).norm();
}

ChainCause cause_named(const TrackingModel& model, const std::string& name, const std::string& segment) {
  for (const ChainCause& cause : possible_causes(model))
    if (cause.name == name && cause.segment == segment) return cause;
  ADD_FAILURE() << name;
  return {};
}

TEST(ChainChanges, AMovedSensorMovesAloneAsARigidBodyInEveryPosture) {
  Rng rng(1);
  const TrackingModel before = test::known_model(test::every_joint_type(), 3);
  VectorXd size(6);
  size << 0.2, -0.3, 0.1, 0.05, 0.02, -0.04;
  const Pose step{exp_so3(size.head<3>()), size.tail<3>()};
  for (const TrackingSensor& moved : before.sensors) {
    const TrackingModel after = changed(before, cause_named(before, moved.name, moved.name), size);
    for (int i = 0; i < 3; ++i) {
      const VectorXd q = some_positions(before, rng);
      const std::vector<Pose> old_poses = body_poses(before, q), new_poses = body_poses(after, q);
      const Pose base = moved.body == 0 ? step.inverse() : Pose{};
      for (const TrackingSensor& sensor : before.sensors) {
        const auto body = static_cast<std::size_t>(sensor.body);
        const Pose expected = sensor.body == moved.body ? base * old_poses[body] * step : base * old_poses[body];
        EXPECT_LT(distance(new_poses[body], expected), 1e-9) << moved.name << " moved, " << sensor.name;
      }
    }
    EXPECT_LT(distance(tool_pose(after, body_poses(after, VectorXd::Zero(after.positions()))),
                       (moved.body == 0 ? step.inverse() : Pose{}) *
                           tool_pose(before, body_poses(before, VectorXd::Zero(before.positions())))),
              1e-9)
        << "the tool stays on its segment";
  }
}

TEST(ChainChanges, AJointThatMovesOnASegmentCarriesWhatIsBeyondIt) {
  const TrackingModel before = test::known_model(test::arm(), 3);
  VectorXd size = VectorXd::Zero(5);
  size.tail<3>() << 0.02, 0.0, 0.0;
  const TrackingModel after = changed(before, cause_named(before, "ins1-ins2", "ins1"), size);
  const VectorXd q = VectorXd::Zero(before.positions());
  const std::vector<Pose> old_poses = body_poses(before, q), new_poses = body_poses(after, q);
  EXPECT_LT(distance(old_poses[1], new_poses[1]), 1e-12);
  const Vec3 shift = old_poses[1].rotation * before.bodies[2].parent_R_axis.col(0) * 0.02;
  for (std::size_t b = 2; b < old_poses.size(); ++b)
    EXPECT_LT((new_poses[b].position - old_poses[b].position - shift).norm(), 1e-9);
}

TEST(ChainChanges, ASensorWithASingleJointHidesAMoveOfThatJoint) {
  const TrackingModel model = test::known_model(test::arm(), 3);
  EXPECT_EQ(cause_named(model, "ins4", "ins4").alternative, "ins3-ins4");
  EXPECT_EQ(cause_named(model, "ins0", "ins0").alternative, "ins0-ins1");
  EXPECT_EQ(cause_named(model, "ins2", "ins2").alternative, "");
  EXPECT_EQ(possible_causes(model).size(), 5u + 6u) << "joints on segments with another joint";
}

TEST(AlignedBodies, DifferOnlyInZerosHoweverTheFramesWereChosen) {
  Rng rng(5);
  const TrackingModel model = test::known_model(test::every_joint_type(), 3);
  TrackingModel other = model;
  for (TrackingBody& body : other.bodies) {
    if (body.motion == TrackingMotion::revolute && body.sensor >= 0 && body.parent_R_axis(1, 1) < 1.0 - 1e-9) {
      const Mat3 turn = rot_z(rng.uniform(-1.0, 1.0));
      body.parent_R_axis = body.parent_R_axis * turn;
      body.child_R_axis = body.child_R_axis * turn * rot_z(rng.uniform(-0.5, 0.5));
      if (body.point_in_parent.norm() > 0.0) {
        body.point_in_child += 0.3 * body.child_R_axis.col(2);
        body.point_in_parent += 0.3 * body.parent_R_axis.col(2);
      }
    }
    if (body.motion == TrackingMotion::prismatic) body.point_in_parent += 0.1 * body.parent_R_axis.col(2);
  }
  const VectorXd offsets = zero_offsets(other, model), q = some_positions(model, rng);
  EXPECT_GT(offsets.norm(), 0.1);
  const std::vector<Pose> poses = body_poses(model, q - offsets), other_poses = body_poses(other, q);
  for (const TrackingSensor& sensor : model.sensors)
    EXPECT_LT(
        distance(poses[static_cast<std::size_t>(sensor.body)], other_poses[static_cast<std::size_t>(sensor.body)]),
        1e-9)
        << sensor.name;
  std::vector<TrackingParameter> geometry;
  for (const TrackingParameter& p : model.parameters)
    if (p.kind <= TrackingParameterKind::point_in_child &&
        !(p.kind == TrackingParameterKind::child_rotation && p.component == 2) &&
        model.bodies[static_cast<std::size_t>(p.index)].motion != TrackingMotion::prismatic)
      geometry.push_back(p);
  EXPECT_LT(difference(model.bodies, aligned(other, model), geometry).norm(), 1e-9);
}

}  // namespace
}  // namespace kinfer
