// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/fits/mount_compliance.hpp"

#include <gtest/gtest.h>

#include "identify/hand_moved_chain.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::HandMovedChain;
using test::refined;

/// Distance between the revolute joints on the middle segment, and its sd.
struct Lever {
  double length, sd;
};

double between(const Vec3& axis, const Vec3& point, const Vec3& other_axis, const Vec3& other_point) {
  return std::abs((other_point - point).dot(axis.cross(other_axis).normalized()));
}

Lever middle_of(const Refinement& found) {
  const JointEstimate &near = found.joints[0].estimate, &far = found.joints[1].estimate;
  return {between(near.axis_in_child, near.point_in_child, far.axis_in_parent, far.point_in_parent),
          std::hypot(near.sd.point_in_child[0], near.sd.point_in_child[1], far.sd.point_in_parent[0])};
}

double true_middle(const HandMovedChain& chain) {
  return between(chain.bodies[1].child_R_axis.col(2), chain.bodies[1].point_in_child, Vec3::UnitX(),
                 chain.bodies[2].point_in_parent);
}

/// Each sensor's mass lies above its mount along z: it tilts about y by the force along x and about −x by that along
/// y.
Mat3 top_heavy(double lean) {
  Mat3 tilt = Mat3::Zero();
  tilt(0, 1) = -lean / 9.81;
  tilt(1, 0) = 0.7 * lean / 9.81;
  return tilt;
}

TEST(MountCompliance, LeversAndCompliancesAreFoundWithEverySensorOnASoftMount) {
  const Mat3 tilt = top_heavy(0.07);
  const HandMovedChain chain(0.0, tilt);
  const Refinement found = refined(chain.recording, 0);
  ASSERT_GT(found.cutoff, 0.0);
  const Lever middle = middle_of(found);
  EXPECT_NEAR(middle.length, true_middle(chain), 2.5 * middle.sd);
  EXPECT_NEAR(middle.length, true_middle(chain), 10e-3);
  EXPECT_LT(middle.sd, 15e-3);
  for (std::size_t s = 0; s < 3; ++s) {
    SCOPED_TRACE(s);
    EXPECT_NEAR(9.81 * found.fit.unknowns.errors[s].tilt(0, 1), 9.81 * tilt(0, 1), 0.03);
    EXPECT_NEAR(9.81 * found.fit.unknowns.errors[s].tilt(1, 0), 9.81 * tilt(1, 0), 0.03);
  }
}

TEST(MountCompliance, RigidMountsAreReportedAsSuchAndKeepTheirIntervals) {
  const HandMovedChain chain;
  const Refinement found = refined(chain.recording, 0);
  ASSERT_GT(found.cutoff, 0.0);
  for (const InsErrors& errors : found.fit.unknowns.errors) EXPECT_LT(9.81 * errors.tilt.cwiseAbs().maxCoeff(), 0.02);
  const Lever middle = middle_of(found);
  EXPECT_NEAR(middle.length, true_middle(chain), 2.5 * middle.sd);
  EXPECT_LT(middle.sd, 6.5e-3);
}

TEST(MountCompliance, UnobservableCompliancesAreAssumedToBeLikeTheObservableOnes) {
  // Nine compliances, of which three are observable to 1e-4 and are 2e-3 each; the others are unobservable.
  InsProblem problem;
  problem.prior.tilt = 1e-2;
  InsFit fit;
  fit.layout.error = {0};
  fit.layout.tilt_error = 0;
  fit.unknowns.errors.resize(1);
  fit.unknowns.errors[0].tilt.col(0).setConstant(2e-3);
  InsCovariance covariance{MatrixXd::Identity(9, 9) * 1e-4, VectorXd::Ones(9)};
  covariance.model.diagonal().head<3>().setConstant(1e-8);
  EXPECT_NEAR(estimate_mount_compliance(problem, fit, covariance), 2e-3, 1e-6);
  covariance.inflation.head<3>().setConstant(1e5);  // then nothing is observable, and the prior stays
  EXPECT_NEAR(estimate_mount_compliance(problem, fit, covariance), problem.prior.tilt, 1e-12);
}

}  // namespace
}  // namespace kinfer
