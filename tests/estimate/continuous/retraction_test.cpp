// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/retraction.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "estimate/continuous/crane.hpp"
#include "kinfer/estimate/continuous/model/azimuth.hpp"
#include "kinfer/estimate/continuous/model/interval_motion.hpp"

namespace kinfer {
namespace {

using test::boom;
using test::Crane;

InsStep no_step(const Crane& crane) {
  return {MatrixXd::Zero(crane.x.spline_coefficients.rows(), crane.x.spline_coefficients.cols()),
          VectorXd::Zero(crane.layout.global_parameters),
          {}};
}

/// To first order a rotation of the boom's sub-tree about the axis of the house, which is vertical.
InsStep azimuth_step(const Crane& crane, double angle) {
  const InsBody &house = crane.x.bodies[1], &child = crane.x.bodies[2];
  const Vec3 axis = house.child_R_axis.col(2), turn = child.parent_R_axis.transpose() * axis;
  InsStep step = no_step(crane);
  step.border.segment<2>(crane.layout.body[2]) = angle * turn.head<2>();
  step.border.segment<3>(crane.layout.body[2] + child.turns()) =
      angle * axis.cross(child.point_in_parent - house.point_in_child);
  step.spline_coefficients.row(crane.layout.spline_dimension[2]).setConstant(angle * turn.z());
  return step;
}

std::vector<InsState> states_of(const Crane& crane, const InsUnknowns& x) {
  return body_states(crane.problem, crane.layout, x, 5, spline_basis(0.3, crane.problem.grid.period));
}

TEST(Retraction, AStepAlongAnAzimuthThatNothingTellsChangesNoSignalHoweverLarge) {
  for (const Vec3& axis : {Vec3(1.0, 0.0, 0.0), Vec3(0.3, 0.5, 0.8), Vec3(0.0, 0.0, 1.0)}) {
    const Crane crane(axis.normalized());
    const auto before = states_of(crane, crane.x);
    for (const double angle : {0.01, 0.5, -2.0}) {
      const InsUnknowns moved = retract(crane.problem, crane.layout, crane.x, azimuth_step(crane, angle));
      EXPECT_NEAR(azimuth_from(azimuth_direction(crane.x.bodies, boom), moved.bodies, boom), angle, 1e-9);
      const auto after = states_of(crane, moved);
      for (std::size_t b = 0; b < before.size(); ++b) {
        EXPECT_LT((after[b].angular_velocity - before[b].angular_velocity).norm(), 1e-9) << angle;
        EXPECT_LT((after[b].force - before[b].force).norm(), 1e-7 * before[b].force.norm()) << angle;
      }
    }
  }
}

/// A retraction agrees with the addition of the step to first order: what differs shrinks with its square.
TEST(Retraction, OfASmallStepIsItsAddition) {
  Rng rng(7);
  for (const Vec3& axis : {Vec3(1.0, 0.0, 0.0), Vec3(0.3, 0.5, 0.8), Vec3(0.0, 0.0, 1.0)}) {
    const Crane crane(axis.normalized());
    InsStep direction = no_step(crane);
    for (double& value : direction.border) value = rng.normal();
    const auto difference = [&](double size) {
      InsStep step = direction;
      step.border *= size;
      const InsUnknowns moved = retract(crane.problem, crane.layout, crane.x, step);
      double largest = 0.0;
      for (std::size_t b = 1; b < crane.x.bodies.size(); ++b) {
        const InsBody added =
            retract(crane.x.bodies[b], step.border.segment(crane.layout.body[b], crane.x.bodies[b].unknowns()));
        largest = std::max({largest, (added.point_in_parent - moved.bodies[b].point_in_parent).norm(),
                            (added.parent_R_axis.col(2) - moved.bodies[b].parent_R_axis.col(2)).norm()});
      }
      return largest;
    };
    EXPECT_GT(difference(1e-2), 1e-6) << "it is not the addition itself";
    EXPECT_NEAR(difference(1e-3) / difference(1e-2), 0.01, 0.005);
  }
}

TEST(Retraction, OfAPointThatMovesWithThePinKeepsTheArm) {
  const Crane crane;
  InsStep step = azimuth_step(crane, 0.7);
  const Vec3 shift(0.1, -0.2, 0.3);  // as if the sensor of the house sat elsewhere
  step.border.segment<3>(crane.layout.body[1] + crane.x.bodies[1].turns() + 3) += shift;
  step.border.segment<3>(crane.layout.body[2] + crane.x.bodies[2].turns()) += shift;
  const auto arm = [](const InsBodies& bodies) { return bodies[2].point_in_parent - bodies[1].point_in_child; };
  InsBodies turned = crane.x.bodies;
  rotate_azimuth(turned, boom, 0.7);
  EXPECT_LT((arm(retract(crane.problem, crane.layout, crane.x, step).bodies) - arm(turned)).norm(), 1e-9);
}

}  // namespace
}  // namespace kinfer
