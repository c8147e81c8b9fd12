// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/tracking_model.hpp"

#include <gtest/gtest.h>

#include "identify/driven_machine.hpp"
#include "identify/hand_moved_chain.hpp"
#include "kinfer/evidence/tracking/body_poses.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;
using Kind = TrackingParameterKind;

/// Pose of each sensor in the base's sensor, by chain.toml's chain.
Pose by_chain(const Identification& found, const std::string& sensor, const VectorXd& q) {
  if (sensor == found.root) return {};
  const auto joint = std::ranges::find(found.chain.joints, sensor, &Joint::name);
  const auto frames = joint_frames(found.chain, q);
  return found.chain.base.pose().inverse() * frames[static_cast<std::size_t>(joint - found.chain.joints.begin())];
}

/// A rotation about the axis itself is the zero of a joint's positions.
bool is_zero(const TrackingParameter& parameter) {
  return parameter.kind == Kind::child_rotation && parameter.component == 2;
}

/// Sum of the variances of some parameters of a body or sensor, but for zeros.
double variance_of(const TrackingModel& model, Kind kind, int index) {
  double sum = 0.0;
  for (std::size_t i = 0; i < model.parameters.size(); ++i)
    if (model.parameters[i].kind == kind && model.parameters[i].index == index && !is_zero(model.parameters[i]))
      sum += model.covariance(static_cast<Index>(i), static_cast<Index>(i));
  return sum;
}

double sum_of_squares(const std::array<double, 2>& sd) {
  return sd[0] * sd[0] + sd[1] * sd[1];
}

void expect_agreement(const Identification& found) {
  constexpr double same = 0.01;  // a slide is anchored here and not in the evidence, which azimuths notice
  ASSERT_TRUE(found.tracking);
  const TrackingModel& model = *found.tracking;
  EXPECT_EQ(position_names(model), active_joint_names(found.chain));
  const MatrixXd& q = found.motion.trajectory.q;
  for (Index column = 0; column < q.cols(); column += 50) {
    const std::vector<Pose> poses = body_poses(model, q.col(column));
    for (const TrackingSensor& sensor : model.sensors) {
      const Pose chain = by_chain(found, sensor.name, q.col(column));
      const Pose& own = poses[static_cast<std::size_t>(sensor.body)];
      EXPECT_LT((own.position - chain.position).norm(), 1e-6) << sensor.name;
      EXPECT_LT((own.rotation - chain.rotation).norm(), 1e-6) << sensor.name;
    }
  }
  for (std::size_t j = 0; j < found.joints.size(); ++j) {
    if (found.joints[j].type != EstimatedJointType::revolute) continue;
    const auto body = std::ranges::find(model.bodies, static_cast<int>(j), &TrackingBody::joint) - model.bodies.begin();
    EXPECT_NEAR(variance_of(model, Kind::parent_rotation, static_cast<int>(body)),
                sum_of_squares(found.joints[j].sd.axis_in_parent),
                same * sum_of_squares(found.joints[j].sd.axis_in_parent));
    EXPECT_NEAR(variance_of(model, Kind::child_rotation, static_cast<int>(body)),
                sum_of_squares(found.joints[j].sd.axis_in_child),
                same * sum_of_squares(found.joints[j].sd.axis_in_child));
  }
  const SymmetricEigen eigen = symmetric_eigen(model.covariance);
  EXPECT_GT(eigen.values[0], -1e-9 * eigen.values[eigen.values.size() - 1]);
  EXPECT_EQ(model.covariance.rows(), static_cast<Index>(model.parameters.size()));
}

class HandedOverMachine : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Every, HandedOverMachine, testing::Values("excavator", "crane", "robot6", "tree"));

TEST_P(HandedOverMachine, MovesAsTheChainDoes) {
  const auto drive = test::driven_machine(GetParam(), 3);
  const Identification found = test::identified(drive.recording);
  expect_agreement(found);
  const TrackingModel& model = *found.tracking;
  EXPECT_FALSE(model.base.moved);
  EXPECT_NEAR(model.gravity, 9.81, 0.03);
  for (const TrackingSensor& sensor : model.sensors) {
    EXPECT_LT(sensor.residual.rate, 3.0 * sensor.noise.rate) << "the chain fits";
    EXPECT_GE(sensor.residual.force, sensor.noise.force);
    EXPECT_NEAR(sensor.sample_period, 0.01, 1e-6);
  }
  for (const TrackingJoint& joint : model.joints)
    for (const TrackingRange& range : joint.range) {
      EXPECT_GT(range.upper - range.lower, 0.1);
      EXPECT_GT(range.speed, 0.05);
      EXPECT_LT(range.speed, 10.0);
    }
}

TEST(TrackingModel, KnowsThatTheBaseMoved) {
  const auto drive = test::driven_arm(3, 4, Script::together, {.base = Base::rocking});
  const Identification found = test::identified(drive.recording);
  expect_agreement(found);
  EXPECT_TRUE(found.tracking->base.moved);
  EXPECT_GT(found.tracking->base.angular_acceleration, 0.01);
}

TEST(TrackingModel, KnowsThatZerosShareTheErrorsOfGeometryAndSensors) {
  const auto drive = test::driven_arm(3, 4);
  const TrackingModel model = *test::identified(drive.recording).tracking;
  std::vector<Index> zeros, others;
  for (std::size_t i = 0; i < model.parameters.size(); ++i)
    (is_zero(model.parameters[i]) ? zeros : others).push_back(static_cast<Index>(i));
  ASSERT_EQ(zeros.size(), model.joints.size());
  const MatrixXd information = *invert_spd(model.covariance(others, others) +
                                           1e-14 * MatrixXd::Identity(std::ssize(others), std::ssize(others)));
  for (std::size_t k = 1; k < zeros.size(); ++k) {  // the first axis is vertical: gravity does not show its zero
    const VectorXd shared = model.covariance(others, zeros[k]);
    const double own = model.covariance(zeros[k], zeros[k]), left = own - shared.dot(information * shared);
    EXPECT_LT(std::sqrt(own), 0.02) << "gravity tells it";
    EXPECT_LT(left, 0.5 * own) << "most of it is the sensors' and the axes'";
  }
}

TEST(TrackingModel, TakesNamedZeros) {
  const auto drive = test::driven_machine("crane", 3);
  IdentifyOptions options;
  options.refine.zeros = {{"ins2", -0.4, elementary::Motion::rotation, 20.0},
                          {"ins2-ins3", 0.25, elementary::Motion::translation, 20.0}};
  const Identification plain = test::identified(drive.recording), named = test::identified(drive.recording, options);
  expect_agreement(named);
  const MatrixXd &before = plain.motion.trajectory.q, &after = named.motion.trajectory.q;
  ASSERT_EQ(before.cols(), after.cols());
  const VectorXd offset = after.col(0) - before.col(0);
  EXPECT_LT(((after - before).colwise() - offset).cwiseAbs().maxCoeff(), 1e-9) << "constant over time";
  EXPECT_EQ(offset[0], 0.0) << "not named";
  const auto& time = named.motion.trajectory.time;
  const auto at = std::ranges::lower_bound(time, 20.0) - time.begin();
  ASSERT_LT(std::abs(time[static_cast<std::size_t>(at)] - 20.0), 0.2);
  EXPECT_NEAR(after(1, at), -0.4, 0.1);
  EXPECT_NEAR(after(2, at), 0.25, 0.1);
}

TEST(TrackingModel, HasOnlyTheSensorsOfTheLinksThatWereFound) {
  const auto drive = test::driven_machine("excavator", 3);
  IdentifyOptions options;
  options.links = 2;
  const Identification found = test::identified(drive.recording, options);
  expect_agreement(found);
  EXPECT_EQ(found.tracking->sensors.size(), 3u);
  EXPECT_EQ(found.tracking->joints.size(), 2u);
}

TEST(TrackingModel, KnowsTheLengthOfABoomAtTheZeroOfItsSlide) {
  const auto drive = test::driven_machine("crane", 3);
  const TrackingModel model = *test::identified(drive.recording).tracking;
  const auto slide = std::ranges::find(model.bodies, TrackingMotion::prismatic, &TrackingBody::motion);
  ASSERT_NE(slide, model.bodies.end());
  EXPECT_LT(std::sqrt(variance_of(model, Kind::point_in_parent, static_cast<int>(slide - model.bodies.begin()))), 0.05);
}

TEST(TrackingModel, OfALooseHingeStatesItsStray) {
  const test::HandMovedChain chain;
  const Refinement refined = test::refined(chain.recording, 0);
  const TrackingModel& model = refined.tracking;
  ASSERT_EQ(model.joints.size(), 2u);
  EXPECT_EQ(model.joints[0].stray, 0.0);
  EXPECT_NEAR(model.joints[1].stray, 0.05 / std::sqrt(2.0), 0.02) << "waves of 0.05 rad in both directions";
  EXPECT_NEAR(model.joints[1].stray_time, 0.19 / 0.27, 0.25) << "cos 2π f t falls to 1/e: waves of 0.23 and 0.31 Hz";
  EXPECT_EQ(model.bodies[2].motion, TrackingMotion::revolute);
  EXPECT_EQ(model.joints[1].range.size(), 1u);
  EXPECT_GT(variance_of(model, Kind::parent_rotation, 2), 0.0);
}

}  // namespace
}  // namespace kinfer
