// SPDX-License-Identifier: Apache-2.0
#include "kinfer/geometry/rotation_vector_motion.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "kinfer/geometry/rotation.hpp"
#include "support/differences.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

constexpr double series_accuracy = 1e-9;  // of the three terms that are taken below 0.2 rad

/// A rotation vector, its first and its second derivative.
struct VectorState {
  Vec3 vector, velocity, acceleration;
  Vec3 at(double t) const { return vector + t * velocity + 0.5 * t * t * acceleration; }
  Vec3 velocity_at(double t) const { return velocity + t * acceleration; }
  RotationVectorMotion motion(double t = 0.0) const {
    return rotation_vector_motion(at(t), velocity_at(t), acceleration);
  }
};

/// Of all lengths up to nearly a whole turn, beside the switch to the series at 0.2 rad too.
std::vector<VectorState> vector_states() {
  std::vector<VectorState> states;
  Rng rng(1);
  for (const double length : {0.0, 1e-9, 1e-3, 0.19, 0.1999, 0.2001, 0.21, 1.0, 3.0, std::numbers::pi, 4.5, 6.0}) {
    const Vec3 direction = test::random_vector(rng).normalized(), velocity = test::random_vector(rng);
    states.push_back({length * direction, velocity, test::random_vector(rng)});
  }
  return states;
}

TEST(RotationVectorMotionOf, VelocityIsThatOfTheRotationMatrix) {
  constexpr double h = 1e-5;
  for (const VectorState& s : vector_states()) {
    const Mat3 slope = (exp_so3(s.at(h)) - exp_so3(s.at(-h))) / (2 * h), omega = exp_so3(s.vector).transpose() * slope;
    EXPECT_LT((skew(s.motion().angular_velocity) - omega).norm(), 1e-8) << s.vector.norm();
  }
}

TEST(RotationVectorMotionOf, AccelerationIsTheDerivativeOfTheVelocity) {
  constexpr double h = 1e-5;
  for (const VectorState& s : vector_states()) {
    const Vec3 slope = (s.motion(h).angular_velocity - s.motion(-h).angular_velocity) / (2 * h);
    EXPECT_LT((s.motion().angular_acceleration - slope).norm(), 1e-7 * (1 + slope.norm())) << s.vector.norm();
  }
}

TEST(RotationVectorMotionOf, JacobianIsTheRightOneOfTheRotationGroup) {
  for (const VectorState& s : vector_states())
    EXPECT_LT((s.motion().jacobian - right_jacobian(s.vector)).norm(), series_accuracy) << s.vector.norm();
}

TEST(RotationVectorMotionOf, DerivativesAgreeWithDifferences) {
  using testing::numeric_jacobian;
  for (const VectorState& s : vector_states()) {
    const RotationVectorMotion m = s.motion();
    const auto by_vector = [&](auto member) {
      return numeric_jacobian(
          [&](const VectorXd& v) { return VectorXd(rotation_vector_motion(v, s.velocity, s.acceleration).*member); },
          s.vector, 1e-5);
    };
    const MatrixXd by_velocity = numeric_jacobian(
        [&](const VectorXd& v) {
          return VectorXd(rotation_vector_motion(s.vector, v, s.acceleration).angular_acceleration);
        },
        s.velocity, 1e-5);
    EXPECT_LT((m.velocity_by_vector - by_vector(&RotationVectorMotion::angular_velocity)).norm(), 1e-7);
    EXPECT_LT((m.acceleration_by_vector - by_vector(&RotationVectorMotion::angular_acceleration)).norm(), 1e-7);
    EXPECT_LT((m.acceleration_by_velocity - by_velocity).norm(), 1e-7);
  }
}

TEST(RotationVectorMotionOf, ASteadyTurnAboutOneAxisIsItsOwnRate) {
  for (const double angle : {0.0, 0.1, 2.0, 6.0}) {
    const RotationVectorMotion m = rotation_vector_motion(Vec3(0, 0, angle), Vec3(0, 0, 1.5), Vec3(0, 0, -0.5));
    EXPECT_LT((m.angular_velocity - Vec3(0, 0, 1.5)).norm(), 1e-14);
    EXPECT_LT((m.angular_acceleration - Vec3(0, 0, -0.5)).norm(), 1e-14);
  }
}

TEST(IntrinsicXyz, RoundTripKeepsTheRotationAlsoNearAndAtTheGimbalLock) {
  constexpr double right = std::numbers::pi / 2;
  for (const double b : {0.0, 0.3, -1.2, right - 1e-9, right, -right, -right + 1e-12})
    for (const double a : {-2.5, 0.0, 1.1, 3.1})
      for (const double c : {-3.0, 0.4}) {
        const Mat3 r = rot_x(a) * rot_y(b) * rot_z(c);
        const Vec3 found = to_intrinsic_xyz(r);
        EXPECT_LT((rot_x(found[0]) * rot_y(found[1]) * rot_z(found[2]) - r).norm(), 2e-8) << a << ' ' << b << ' ' << c;
        EXPECT_LT((found - Vec3(a, b, c)).norm(), std::abs(b) < 1.3 ? 1e-12 : 10.0);
      }
}

TEST(IntrinsicXyz, LastAngleIsZeroAtTheGimbalLock) {
  EXPECT_EQ(to_intrinsic_xyz(rot_x(0.4) * rot_y(std::numbers::pi / 2) * rot_z(0.3)).z(), 0.0);
}

TEST(AngleBetween, OfOrientationsIsTheAngleOfTheirDifference) {
  Rng rng(5);
  for (const double angle : {0.0, 1e-9, 0.5, 3.0, std::numbers::pi}) {
    const Mat3 a = exp_so3(test::random_vector(rng));
    const Mat3 b = a * exp_so3(angle * test::random_vector(rng).normalized());
    EXPECT_NEAR(angle_between(a, b), angle, 2e-8);
    EXPECT_NEAR(angle_between(b, a), angle, 2e-8);
  }
}

}  // namespace
}  // namespace kinfer
