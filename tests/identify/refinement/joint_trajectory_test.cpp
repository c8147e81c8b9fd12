// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/joints/joint_trajectory.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/rng.hpp"
#include "kinfer/identify/geometry/initial_joint.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;
using test::bodies_of;
using test::pose_of;

struct Played {
  Chain chain;
  MatrixXd trajectory;
  std::vector<Pose> truth;
};

Played played(EstimatedJointType type, std::uint64_t seed) {
  Rng rng(seed);
  const std::vector<InsBody> bodies = bodies_of(type, rng);
  const SplineGrid grid{.begin = 2.0, .period = 0.1, .intervals = 12};
  Index freedom = 0, unknowns = 0;
  for (const InsBody& body : bodies) freedom += degrees_of_freedom(body.motion), unknowns += body.unknowns();
  MatrixXd band(freedom, grid.coefficients());
  for (double& value : band.reshaped()) value = 0.5 * rng.normal();
  const std::vector<double> times{2.0, 2.17, 2.5, 2.93, 3.2};
  const VectorXd zero = spline_value(grid, band, grid.begin);
  const bool is_ball = type == EstimatedJointType::spherical;
  const Mat3 axes = is_ball ? spherical_axes(spherical_rotation_vectors(grid, band, times)) : Mat3(Mat3::Identity());
  RefinedJoint joint = refined_joint(type, bodies, std::span(zero.data(), static_cast<std::size_t>(zero.size())),
                                     MatrixXd::Identity(unknowns, unknowns), axes);
  joint.estimate.parent = "a";
  joint.estimate.child = "b";
  Played result{build_chain("a", {joint.estimate}, canonical_dh_rows(joint.estimate, joint.solution), Mat3::Identity()),
                joint_trajectory(type, bodies, joint.solution.geometry, joint.zero, grid, band, times),
                {}};
  for (const double t : times) result.truth.push_back(pose_of(bodies, spline_value(grid, band, t)));
  return result;
}

constexpr std::array every_type{EstimatedJointType::revolute, EstimatedJointType::prismatic,
                                EstimatedJointType::universal, EstimatedJointType::spherical};

double largest_difference(const Pose& a, const Pose& b) {
  return std::max((a.rotation - b.rotation).cwiseAbs().maxCoeff(), (a.position - b.position).cwiseAbs().maxCoeff());
}

TEST(JointTrajectory, MovesTheIdentifiedChainAsTheFitDoes) {
  for (const EstimatedJointType type : every_type)
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Played p = played(type, seed);
      ASSERT_EQ(dof(p.chain), p.trajectory.rows());
      EXPECT_LT(p.trajectory.col(0).norm(), 1e-12) << "the zero is where the recording begins";
      for (std::size_t i = 0; i < p.truth.size(); ++i) {
        const Pose found = joint_frames(p.chain, p.trajectory.col(static_cast<Index>(i))).back();
        EXPECT_LT(largest_difference(found, p.truth[i]), 1e-9) << name(type) << " " << seed << " " << i;
      }
    }
}

TEST(JointTrajectory, IsReadBackFromTheFilesWithTheSamePoses) {
  for (const EstimatedJointType type : every_type) {
    const Played p = played(type, 9);
    const auto from_urdf = parse_urdf(format_urdf(p.chain), "chain.urdf");
    const auto from_toml = parse_robot_toml(format_robot_toml({.chain = p.chain}), "chain.toml");
    ASSERT_TRUE(from_urdf && from_toml);
    for (Index i = 0; i < p.trajectory.cols(); ++i) {
      const Pose before = forward(p.chain, p.trajectory.col(i));
      EXPECT_LT(largest_difference(before, forward(*from_urdf, p.trajectory.col(i))), 1e-9) << name(type);
      EXPECT_LT(largest_difference(before, forward(from_toml->chain, p.trajectory.col(i))), 1e-9) << name(type);
    }
  }
}

TEST(JointTrajectory, CardanAnglesAreContinuousThroughTheirSingularity) {
  Vec3 angles = Vec3::Zero();
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.01 * i;
    const Mat3 r = rot_x(0.3 * t) * rot_y(t * std::numbers::pi / 2.0) * rot_z(-0.2 * t);  // through 90° to 180°
    angles = cardan_angles(r, angles);
    EXPECT_LT((rot_x(angles.x()) * rot_y(angles.y()) * rot_z(angles.z()) - r).norm(), 1e-7) << i;
  }
  EXPECT_NEAR(angles.y(), std::numbers::pi, 1e-6);
}

TEST(JointTrajectory, ASphericalJointRotatesMostAboutItsFirstAxisAndLeastAboutItsSecond) {
  MatrixXd turns(3, 3);
  turns << 0.1, -0.1, 0.0, 0.5, -0.4, 0.2, 1.0, 2.0, -1.5;
  const Mat3 axes = spherical_axes(turns);
  const Vec3 size = (axes.transpose() * turns).rowwise().norm();
  EXPECT_GT(size.x(), size.z());
  EXPECT_GT(size.z(), size.y());
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
}

}  // namespace
}  // namespace kinfer
