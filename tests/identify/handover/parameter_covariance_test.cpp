// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/parameter_covariance.hpp"

#include <gtest/gtest.h>

#include "kinfer/identify/geometry/initial_joint.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;

/// A root and one joint, which consists of these bodies, with nothing uncertain but its mounts.
struct SoftJoint {
  InsProblem problem;
  InsFit fit{.unknowns = {}, .layout = {}, .cost = {}};
  JointBodies joint;

  SoftJoint(EstimatedJointType type, const InsBodies& bodies) {
    problem.sensors.resize(2);
    fit.unknowns.bodies = bodies;
    fit.unknowns.errors.resize(2);
    fit.layout = layout_of(problem, bodies);
    joint.type = type;
    joint.parent = 0, joint.child = 1;
    joint.first = 1, joint.last = bodies.size() - 1;
  }

  VectorXd variances(double parent, double child) const {
    const Index size = fit.layout.global_parameters;
    InsCovariance none;
    none.model = MatrixXd::Zero(size, size);
    none.inflation = VectorXd::Ones(size);
    ModelError error;
    for (const InsBody& body : fit.unknowns.bodies) error.shift.push_back(MatrixXd::Zero(body.unknowns(), 1));
    error.mount_deflection = {parent, child};
    return parameter_covariance(fit, none, error, {&joint, 1}, 0.0).diagonal();
  }
};

TEST(ParameterCovariance, MountsThatGiveWayTurnTheAxesOfAHinge) {
  const SoftJoint hinge(EstimatedJointType::revolute,
                        {{.sensor = 0}, revolute_body(0, 1, Mat3::Identity(), Mat3::Identity())});
  const VectorXd variances = hinge.variances(1e-2, 2e-2);
  const Index first = hinge.fit.layout.body[1];
  VectorXd expected = VectorXd::Zero(variances.size());
  expected.segment<2>(first).setConstant(1e-4);
  expected.segment<2>(first + 2).setConstant(4e-4);
  EXPECT_LT((variances - expected).norm(), 1e-15);
}

TEST(ParameterCovariance, AndThoseOfAUniversalJointWhichAreUnknownsOfTwoBodies) {
  InsBody near = revolute_body(0, -1, Mat3::Identity(), Mat3::Identity()),
          far = revolute_body(1, 1, Mat3::Identity(), Mat3::Identity());
  near.free_child_rotation = {}, near.free_point_in_child = false;
  far.free_parent_rotation = {false, true, false}, far.free_point_in_parent = false;
  const SoftJoint universal(EstimatedJointType::universal, {{.sensor = 0}, near, far});
  const VectorXd variances = universal.variances(1e-2, 2e-2);
  VectorXd expected = VectorXd::Zero(variances.size());
  expected.segment<2>(universal.fit.layout.body[1]).setConstant(1e-4);
  expected.segment<2>(universal.fit.layout.body[2] + 1).setConstant(4e-4);  // after the angle between the axes
  EXPECT_LT((variances - expected).norm(), 1e-15);
}

}  // namespace
}  // namespace kinfer
