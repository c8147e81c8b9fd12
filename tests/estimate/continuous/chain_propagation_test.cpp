// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/chain_propagation.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/rng.hpp"
#include "support/differences.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using test::random_vector;
using testing::numeric_jacobian;

VectorXd flat(const InsState& s) {
  VectorXd x(state_size);
  x << s.angular_velocity, s.angular_acceleration, s.force;
  return x;
}

InsState state_of(ConstVectorRef x) {
  return {x.head<3>(), x.segment<3>(3), x.tail<3>()};
}

std::vector<InsBody> bodies_of_every_kind(Rng& rng) {
  const auto random_rotation = [&] { return exp_so3(random_vector(rng)); };
  std::vector<InsBody> bodies{test::random_revolute_body(0, 1, rng), test::random_prismatic_body(0, 1, rng),
                              fixed_body(0, 1, random_rotation()), spherical_body(0, 1, random_rotation())};
  for (InsBody& body : bodies) {
    body.point_in_parent = random_vector(rng);
    if (body.free_point_in_child) body.point_in_child = random_vector(rng);
  }
  bodies.push_back(bodies[0]);
  bodies.back().free_parent_rotation = {false, true, true};
  bodies.back().free_point_in_parent = false;
  return bodies;
}

TEST(ChainPropagation, DerivativesAgreeWithDifferences) {
  Rng rng(5);
  for (const InsBody& body : bodies_of_every_kind(rng)) {
    const InsState parent{random_vector(rng), random_vector(rng), random_vector(rng)};
    const JointKinematicState q{Vec3(0.4, 0.8, -0.3), Vec3(-0.7, 0.2, 0.9), Vec3(1.3, -0.5, 0.4)};
    PropagatedDerivative derivative;
    propagate(body, q, parent, derivative);
    EXPECT_LT((flat(derivative.state) - flat(propagated(body, q, parent))).norm(), 1e-14);
    const MatrixXd by_parent =
        numeric_jacobian([&](const VectorXd& x) { return flat(propagated(body, q, state_of(x))); }, flat(parent));
    EXPECT_LT((derivative.by_parent - by_parent).norm(), 1e-7);
    const Index variables = 3 * degrees_of_freedom(body.motion), n = variables + body.unknowns();
    const MatrixXd by_own = numeric_jacobian(
        [&](const VectorXd& x) {
          JointKinematicState moved = q;
          for (Index k = 0; k < variables; ++k) moved[static_cast<std::size_t>(k % 3)][k / 3] += x[k];
          return flat(propagated(retract(body, x.tail(n - variables)), moved, parent));
        },
        VectorXd::Zero(n));
    EXPECT_LT((derivative.by_own - by_own).norm(), 1e-7) << static_cast<int>(body.motion);
  }
}

/// Reference: position and orientation of a child on an arbitrarily moving parent, differentiated numerically.
TEST(ChainPropagation, SpecificForceIsThatOfThePointsMotion) {
  Rng rng(6);
  const auto bodies = bodies_of_every_kind(rng);
  const Vec3 spin = random_vector(rng), sweep = random_vector(rng), up(0.0, 0.0, 9.81);
  const auto parent_rotation = [&](double t) { return Mat3(exp_so3(std::sin(t) * spin) * exp_so3(t * t * sweep)); };
  const auto parent_position = [&](double t) { return Vec3(std::sin(2 * t) * spin + t * t * t * sweep); };
  const auto joint_position = [](double t) { return Vec3(0.3 + std::sin(1.7 * t), t * t, std::cos(t)); };
  constexpr double t0 = 0.3, h = 1e-3;
  const auto second = [&](const auto& f) { return Vec3((f(t0 + h) - 2.0 * f(t0) + f(t0 - h)) / (h * h)); };
  const auto angular_velocity_at = [&](const auto& rotation, double t) {
    return Vec3(log_so3(Mat3(rotation(t - h).transpose() * rotation(t + h))) / (2.0 * h));
  };
  const auto measured_state = [&](const auto& rotation, const auto& position) {
    InsState s;
    s.angular_velocity = angular_velocity_at(rotation, t0);
    s.angular_acceleration =
        (angular_velocity_at(rotation, t0 + h) - angular_velocity_at(rotation, t0 - h)) / (2.0 * h);
    s.force = rotation(t0).transpose() * (second(position) + up);
    return s;
  };
  for (const InsBody& body : bodies) {
    const auto q = [&](double t) { return Vec3(body.motion == JointMotion::fixed ? Vec3::Zero() : joint_position(t)); };
    const auto child_rotation = [&](double t) {
      const Mat3 moved = body.motion == JointMotion::revolute    ? rot_z(q(t).x())
                         : body.motion == JointMotion::spherical ? exp_so3(q(t))
                                                                 : Mat3(Mat3::Identity());
      return Mat3(parent_rotation(t) * body.parent_R_axis * moved * body.child_R_axis.transpose());
    };
    const auto child_position = [&](double t) {
      const double displacement = body.motion == JointMotion::prismatic ? q(t).x() : 0.0;
      const Vec3 joint = body.point_in_parent + displacement * body.parent_R_axis.col(2);
      return Vec3(parent_position(t) + parent_rotation(t) * joint - child_rotation(t) * body.point_in_child);
    };
    const JointKinematicState now{q(t0), (q(t0 + h) - q(t0 - h)) / (2 * h), second(q)};
    const InsState actual = propagated(body, now, measured_state(parent_rotation, parent_position)),
                   expected = measured_state(child_rotation, child_position);
    EXPECT_LT((flat(actual) - flat(expected)).norm(), 2e-4) << static_cast<int>(body.motion);
  }
}

}  // namespace
}  // namespace kinfer
