// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/tracked_bodies.hpp"

#include <gtest/gtest.h>

#include "kinfer/evidence/tracking/body_poses.hpp"
#include "kinfer/geometry/cardan_angles.hpp"
#include "kinfer/identify/refinement/joints/refined_joint.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;

constexpr std::array every_tracked_type{EstimatedJointType::revolute, EstimatedJointType::prismatic,
                                        EstimatedJointType::universal, EstimatedJointType::spherical,
                                        EstimatedJointType::rigid};

std::vector<InsBody> joint_of(EstimatedJointType type, Rng& rng) {
  if (type != EstimatedJointType::rigid) return test::bodies_of(type, rng);
  InsBody body = fixed_body(0, 1, test::random_rotation(rng));
  body.point_in_parent = test::random_vector(rng);
  return {body};
}

Index unknowns_of_all(const std::vector<InsBody>& bodies) {
  Index sum = 0;
  for (const InsBody& body : bodies) sum += body.unknowns();
  return sum;
}

/// The fit's positions -> those of the chain.
VectorXd chain_positions(EstimatedJointType type, const std::vector<InsBody>& bodies, const VectorXd& zero,
                         const JointGeometry& geometry, const VectorXd& fitted) {
  if (type == EstimatedJointType::rigid) return {};
  if (type == EstimatedJointType::spherical) {
    const Mat3 turn = exp_so3(Vec3(fitted)) * exp_so3(Vec3(zero)).transpose();
    return cardan_angles(geometry.spherical_axes.transpose() * turn * geometry.spherical_axes, Vec3::Zero());
  }
  const double sense = bodies.size() == 1 ? axis_sense(bodies.front()) : 1.0;
  return sense * (fitted - zero);
}

Pose pose_of_tracked(const std::vector<TrackingBody>& bodies, const VectorXd& q) {
  Pose pose;
  Index next = 0;
  for (const TrackingBody& body : bodies) {
    const int count = degrees_of_freedom(body.motion);
    pose = pose * body_pose(body, q.segment(next, count));
    next += count;
  }
  return pose;
}

/// The bodies with each parameter changed as its definition says.
std::vector<TrackingBody> changed(std::vector<TrackingBody> bodies, const std::vector<TrackingParameter>& parameters,
                                  const VectorXd& step) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    TrackingBody& body = bodies[static_cast<std::size_t>(parameters[i].index)];
    const Vec3 by = step[static_cast<Index>(i)] * Vec3::Unit(parameters[i].component);
    if (parameters[i].kind == TrackingParameterKind::parent_rotation)
      body.parent_R_axis = body.parent_R_axis * exp_so3(by);
    if (parameters[i].kind == TrackingParameterKind::child_rotation)
      body.child_R_axis = body.child_R_axis * exp_so3(by);
    if (parameters[i].kind == TrackingParameterKind::point_in_parent) body.point_in_parent += by;
    if (parameters[i].kind == TrackingParameterKind::point_in_child) body.point_in_child += by;
  }
  return bodies;
}

double pose_difference(const Pose& a, const Pose& b) {
  return std::max((a.rotation - b.rotation).norm(), (a.position - b.position).norm());
}

class TrackedJoint : public testing::TestWithParam<std::pair<EstimatedJointType, int>> {
 protected:
  void SetUp() override {
    const auto [type, seed] = GetParam();
    Rng rng(static_cast<std::uint64_t>(seed));
    bodies_ = joint_of(type, rng);
    const Index freedom = type == EstimatedJointType::spherical ? 3 : type == EstimatedJointType::universal ? 2 : 1;
    zero_ = VectorXd::Zero(freedom);
    fitted_ = VectorXd::Zero(freedom);
    if (type != EstimatedJointType::rigid)
      for (Index k = 0; k < freedom; ++k) zero_[k] = 0.5 * rng.normal(), fitted_[k] = 0.5 * rng.normal();
    joint_ = refined_joint(type, bodies_, std::span(zero_.data(), static_cast<std::size_t>(freedom)),
                           MatrixXd::Identity(unknowns_of_all(bodies_), unknowns_of_all(bodies_)),
                           type == EstimatedJointType::spherical ? test::random_rotation(rng) : Mat3(Mat3::Identity()));
    tracked_ = tracked_bodies(type, bodies_, joint_.zero, joint_.solution.geometry);
  }

  VectorXd positions() const {
    return chain_positions(GetParam().first, bodies_, zero_, joint_.solution.geometry, fitted_);
  }
  Pose fitted_pose(const std::vector<InsBody>& bodies) const {
    if (GetParam().first == EstimatedJointType::rigid) {
      const Mat3 r = bodies.front().child_R_axis.transpose();
      return {r, bodies.front().point_in_parent};
    }
    return test::pose_of(bodies, fitted_);
  }

  std::vector<InsBody> bodies_;
  VectorXd zero_, fitted_;
  RefinedJoint joint_;
  TrackedBodies tracked_;
};

TEST_P(TrackedJoint, MovesAsTheFitDoes) {
  EXPECT_LT(pose_difference(pose_of_tracked(tracked_.bodies, positions()), fitted_pose(bodies_)), 1e-9);
}

TEST_P(TrackedJoint, ChangesWithTheFitsUnknownsAsTheJacobianSays) {
  constexpr double step = 1e-5;
  Index column = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (Index k = 0; k < bodies_[b].unknowns(); ++k, ++column) {
      std::vector<InsBody> moved = bodies_;
      moved[b] = retract(bodies_[b], step * VectorXd::Unit(bodies_[b].unknowns(), k));
      const auto follows = changed(tracked_.bodies, tracked_.parameters, step * tracked_.jacobian.col(column));
      EXPECT_LT(pose_difference(pose_of_tracked(follows, positions()), fitted_pose(moved)), 1e-8)
          << "body " << b << ", unknown " << k;
    }
  EXPECT_EQ(tracked_.jacobian.cols(), column);
  EXPECT_EQ(tracked_.jacobian.rows(), static_cast<Index>(tracked_.parameters.size()));
}

TEST(TrackedBodies, ShiftingBothPointsOfAHingeAlongTheAxisChangesNothing) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Rng rng(seed);
    const std::vector<InsBody> bodies = test::bodies_of(EstimatedJointType::revolute, rng);
    const double zero = 0.3;
    const RefinedJoint joint =
        refined_joint(EstimatedJointType::revolute, bodies, {&zero, 1}, MatrixXd::Identity(10, 10));
    const TrackedBodies tracked =
        tracked_bodies(EstimatedJointType::revolute, bodies, joint.zero, joint.solution.geometry);
    VectorXd slide(10);
    slide << VectorXd::Zero(4), bodies[0].parent_R_axis.col(2), bodies[0].child_R_axis.col(2);
    EXPECT_LT((tracked.jacobian * slide).norm(), 1e-9);
    EXPECT_NEAR(tracked.bodies[0].point_in_child.dot(tracked.bodies[0].child_R_axis.col(2)), 0.0, 1e-12);
  }
}

std::vector<std::pair<EstimatedJointType, int>> every_case() {
  std::vector<std::pair<EstimatedJointType, int>> cases;
  for (const EstimatedJointType type : every_tracked_type)
    for (int seed = 1; seed <= 3; ++seed) cases.emplace_back(type, seed);
  return cases;
}

INSTANTIATE_TEST_SUITE_P(EveryType, TrackedJoint, testing::ValuesIn(every_case()), [](const auto& one) {
  return std::string(name(one.param.first)) + std::to_string(one.param.second);
});

}  // namespace
}  // namespace kinfer
