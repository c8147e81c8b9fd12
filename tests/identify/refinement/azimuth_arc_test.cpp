// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/joints/azimuth_arc.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;

constexpr double radius = 0.6;  // [m]

/// A joint behind a body that rotates about its z, and the covariance of its azimuth.
struct CarriedJoint {
  InsBodies bodies{{.sensor = 0},
                   revolute_body(0, 1, Mat3::Identity(), Mat3::Identity()),
                   revolute_body(1, 2, frame_with_z_along(Vec3::UnitY()), Mat3::Identity())};
  InsLayout layout;
  VectorXd turn;  // of the joint's unknowns, by the azimuth

  CarriedJoint() {
    bodies[1].point_in_child = Vec3(-0.3, 0.1, -0.2);
    bodies[2].point_in_parent = bodies[1].point_in_child + Vec3(radius, 0.0, 0.4);
    InsProblem problem;
    problem.sensors.resize(bodies.size());
    layout = layout_of(problem, bodies);
    turn = VectorXd::Zero(layout.global_parameters);
    const Mat3& frame = bodies[2].parent_R_axis;
    const Vec3 axis_change = Vec3::UnitZ().cross(frame.col(2));
    turn[layout.body[2]] = -axis_change.dot(frame.col(1));
    turn[layout.body[2] + 1] = axis_change.dot(frame.col(0));
    turn.segment<3>(point()) = Vec3(0.0, radius, 0.0);
  }
  Index point() const { return layout.body[2] + bodies[2].turns(); }
  MatrixXd covariance(double azimuth_sd) const { return azimuth_sd * azimuth_sd * turn * turn.transpose(); }
  AzimuthArc arc(double azimuth_sd) const { return *azimuth_arc(layout, bodies, covariance(azimuth_sd), 2); }
  /// Of the point, in the frame of the body that carries it.
  Mat3 point_covariance(double azimuth_sd) const {
    const Index first = bodies[2].turns();
    return covariance(azimuth_sd).block<3, 3>(point(), point()) +
           arc(azimuth_sd).beyond_tangent.block<3, 3>(first, first);
  }
};

TEST(AzimuthArc, OfAnUncertainAzimuthLeavesItsTangentTowardsTheCentre) {
  const CarriedJoint joint;
  for (const double sd : {0.01, 0.05, 0.15}) {
    const Mat3 covariance = joint.point_covariance(sd);
    const double radial = 0.75 * std::pow(sd, 4);  // E (1 − cos)² to the fourth order
    EXPECT_NEAR(covariance(0, 0), radius * radius * radial, 0.05 * radius * radius * radial);
    EXPECT_NEAR(covariance(1, 1), radius * radius * sd * sd, 1e-12);
    EXPECT_NEAR(covariance(2, 2), 0.0, 1e-12);
    EXPECT_NEAR(joint.arc(sd).azimuth_sd, sd, 1e-12);
    EXPECT_FALSE(is_open(joint.arc(sd)));
  }
}

TEST(AzimuthArc, OfAnOpenAzimuthIsTheWholeCircle) {
  const CarriedJoint joint;
  const Mat3 covariance = joint.point_covariance(0.6);
  EXPECT_NEAR(covariance(0, 0), 1.5 * radius * radius, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 0.5 * radius * radius, 1e-12);
  EXPECT_TRUE(is_point_lost(joint.arc(0.6)));
  CarriedJoint near;
  near.bodies[2].point_in_parent = near.bodies[1].point_in_child + Vec3(0.2, 0.0, 0.4);
  EXPECT_FALSE(is_point_lost(near.arc(0.6))) << "it is within 0.4 m";
}

/// Errors of the axis alone do not move a point that is known.
TEST(AzimuthArc, OfAPointThatIsKnownBetterThanItsAxisIsShort) {
  const CarriedJoint joint;
  MatrixXd covariance = joint.covariance(0.1);
  covariance.middleRows<3>(joint.point()).setZero();
  covariance.middleCols<3>(joint.point()).setZero();
  const auto arc = azimuth_arc(joint.layout, joint.bodies, covariance, 2);
  ASSERT_TRUE(arc);
  EXPECT_NEAR(arc->azimuth_sd, 0.0, 1e-12);
  EXPECT_NEAR(arc->beyond_tangent.norm(), 0.0, 1e-12);
}

TEST(AzimuthArc, IsNoneOfAJointOnTheRoot) {
  const CarriedJoint joint;
  EXPECT_FALSE(azimuth_arc(joint.layout, joint.bodies, joint.covariance(0.6), 1));
}

}  // namespace
}  // namespace kinfer
