// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/azimuth.hpp"

#include <gtest/gtest.h>

#include "estimate/continuous/crane.hpp"
#include "kinfer/estimate/continuous/model/interval_motion.hpp"
#include "kinfer/estimate/continuous/solver/fact_residuals.hpp"
#include "support/differences.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using test::boom;
using test::Crane;

TEST(AzimuthOfASubtree, AreThoseOfTheJointsOnBodiesThatRotate) {
  const Crane crane;
  const auto azimuths = azimuths_of(crane.x.bodies);
  ASSERT_EQ(azimuths.size(), 2u);
  EXPECT_EQ(azimuths[0].child, 2u);
  EXPECT_EQ(azimuths[1].child, 3u);
}

TEST(AzimuthOfASubtree, IsTheAngleThatItWasRotatedBy) {
  for (const Vec3& axis : {Vec3(1.0, 0.0, 0.0), Vec3(0.3, 0.5, 0.8), Vec3(0.0, 0.0, 1.0)}) {
    Crane crane(axis.normalized());
    const Vec3 direction = azimuth_direction(crane.x.bodies, boom);
    rotate_azimuth(crane.x.bodies, boom, 2.5);
    EXPECT_NEAR(azimuth_from(direction, crane.x.bodies, boom), 2.5, 1e-9);
  }
}

TEST(AzimuthOfASubtree, ChangesNoSignalWhereTheAxisIsVertical) {
  Crane crane;
  const auto states = [&] {
    const SplineBasis basis = spline_basis(0.3, crane.problem.grid.period);
    return body_states(crane.problem, crane.layout, crane.x, 5, basis);
  };
  const auto before = states();
  rotate_azimuth(crane.x.bodies, boom, 1.3);
  const auto after = states();
  for (std::size_t b = 0; b < before.size(); ++b) {
    EXPECT_LT((after[b].angular_velocity - before[b].angular_velocity).norm(), 1e-9);
    EXPECT_LT((after[b].force - before[b].force).norm(), 1e-7 * before[b].force.norm());
  }
  crane.x.root_force += Vec3(1.0, 0.0, 0.0);  // a slope
  rotate_azimuth(crane.x.bodies, boom, -1.3);
  const Vec3 sloping = states()[2].force;
  rotate_azimuth(crane.x.bodies, boom, 1.3);
  EXPECT_GT((states()[2].force - sloping).norm(), 0.1);
}

TEST(AzimuthOfASubtree, GradientAgreesWithDifferences) {
  for (const Vec3& axis : {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)}) {
    const Crane crane(axis);
    const Index first = crane.layout.body[2], count = crane.x.bodies[2].unknowns();
    const Vec3 direction = azimuth_direction(crane.x.bodies, boom);
    const MatrixXd numeric = testing::numeric_jacobian(
        [&](const VectorXd& step) {
          InsBodies moved = crane.x.bodies;
          moved[2] = retract(moved[2], step);
          return VectorXd::Constant(1, azimuth_from(direction, moved, boom));
        },
        VectorXd::Zero(count));
    const VectorXd gradient = azimuth_gradient(crane.layout, crane.x.bodies, boom);
    EXPECT_LT((gradient.segment(first, count).transpose() - numeric).norm(), 1e-6);
  }
}

TEST(AzimuthOfASubtree, AsAFactPullsTowardsWhatWasMeasured) {
  Crane crane;
  InsBodies measured = crane.x.bodies;
  rotate_azimuth(measured, boom, 0.2);
  crane.problem.facts.azimuth = {{boom}, {azimuth_direction(measured, boom)}, MatrixXd::Constant(1, 1, 100.0)};
  EXPECT_NEAR(fact_cost(crane.problem, crane.layout, crane.x), 400.0, 1e-6);
  const auto rows = fact_rows(crane.problem, crane.layout, crane.x);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_NEAR(rows[0].left[0], 20.0, 1e-9);
  const Index local = spline_order * crane.layout.spline_dimensions;
  const VectorXd expected = 100.0 * azimuth_gradient(crane.layout, crane.x.bodies, boom);
  EXPECT_LT((rows[0].derivative.rightCols(crane.layout.global_parameters).transpose() - expected).norm(), 1e-12);
  EXPECT_EQ(rows[0].derivative.leftCols(local).norm(), 0.0);
}

}  // namespace
}  // namespace kinfer
