// SPDX-License-Identifier: Apache-2.0
#include "kinfer/geometry/rotation.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/geometry/random.hpp"
#include "support/differences.hpp"

namespace kinfer {
namespace {

using std::numbers::pi;
using testing::numeric_jacobian;

Vec3 random_direction(Rng& rng) {
  return normal_vector(rng).normalized();
}

/// Rotation vectors of all lengths from 0 to π, near the switch to the series and near π too.
std::vector<Vec3> rotation_vectors() {
  std::vector<Vec3> vectors{Vec3::Zero()};
  Rng rng(1);
  for (const double length : {1e-100, 1e-12, 1e-9, 0.99e-4, 1.01e-4, 1.99e-4, 2.01e-4, 1e-3, 0.1, 1.0, 2.0, 3.0,
                              pi - 1e-6, pi - 1e-10, pi - 1e-13}) {
    for (int i = 0; i < 10; ++i) vectors.push_back(length * random_direction(rng));
    for (int axis = 0; axis < 3; ++axis) vectors.push_back(length * Vec3::Unit(axis));
  }
  return vectors;
}

/// Reference for exp(skew(v)): the power series of the matrix v / 2^10, squared ten times.
Mat3 exponential_series(const Vec3& v) {
  const Mat3 k = skew(v / 1024.0);
  Mat3 sum = Mat3::Identity(), term = Mat3::Identity();
  for (int i = 1; i < 20; ++i) sum += term = term * k / i;
  for (int i = 0; i < 10; ++i) sum = sum * sum;
  return sum;
}

TEST(Rotation, SkewIsTheCrossProduct) {
  Rng rng(2);
  const Vec3 v = random_direction(rng), w = random_direction(rng);
  EXPECT_LT((skew(v) * w - v.cross(w)).norm(), 1e-16);
}

TEST(Rotation, ElementaryRotationsFollowTheRightHandRule) {
  EXPECT_LT((rot_x(pi / 2) * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_LT((rot_y(pi / 2) * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-15);
  EXPECT_LT((rot_z(pi / 2) * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((exp_so3(0.7 * Vec3::UnitX()) - rot_x(0.7)).norm(), 1e-15);
  EXPECT_LT((exp_so3(0.7 * Vec3::UnitY()) - rot_y(0.7)).norm(), 1e-15);
  EXPECT_LT((exp_so3(0.7 * Vec3::UnitZ()) - rot_z(0.7)).norm(), 1e-15);
}

TEST(Rotation, ExponentialIsThePowerSeriesOfTheSkewMatrix) {
  for (const Vec3& v : rotation_vectors()) {
    EXPECT_LT((exp_so3(v) - exponential_series(v)).norm(), 1e-12) << v.norm();  // squaring loses three digits
    EXPECT_LT((quat_exp(v).toRotationMatrix() - exp_so3(v)).norm(), 3e-15) << v.norm();
  }
}

TEST(Rotation, ExponentialIsARotation) {
  for (const Vec3& v : rotation_vectors()) {
    const Mat3 r = exp_so3(v);
    EXPECT_LT((r * r.transpose() - Mat3::Identity()).norm(), 3e-15) << v.norm();
    EXPECT_NEAR(r.determinant(), 1.0, 3e-15);
  }
}

TEST(Rotation, LogarithmUndoesTheExponentialFromZeroToPi) {
  for (const Vec3& v : rotation_vectors()) {
    // Relative where v is small, and without loss near π.
    EXPECT_LE((quat_log(quat_exp(v)) - v).norm(), 3e-15 * v.norm()) << v.norm();
    EXPECT_LT((log_so3(exp_so3(v)) - v).norm(), 5e-15) << v.norm();
  }
}

TEST(Rotation, LogarithmOfHalfATurnIsPiAboutTheAxisOrItsOpposite) {
  Rng rng(3);
  for (int i = 0; i < 20; ++i) {
    const Vec3 axis = i < 3 ? Vec3(Vec3::Unit(i)) : random_direction(rng);
    const Mat3 half_turn = 2.0 * axis * axis.transpose() - Mat3::Identity();
    const Vec3 v = log_so3(half_turn);
    EXPECT_NEAR(v.norm(), pi, 1e-14);
    EXPECT_NEAR(std::abs(v.normalized().dot(axis)), 1.0, 1e-14);
  }
}

TEST(Rotation, OppositeQuaternionsHaveTheSameLogarithm) {
  for (const Vec3& v : rotation_vectors()) {
    const Quat q = quat_exp(v), opposite(-q.coeffs());
    EXPECT_LT((quat_log(q) - quat_log(opposite)).norm(), 1e-15);
  }
}

TEST(Rotation, RightJacobianIsTheDerivativeOfTheExponential) {
  Rng rng(4);
  for (const double length : {0.0, 1e-5, 0.9e-4, 1.1e-4, 1e-2, 1.0, 3.0}) {
    const Vec3 v = length * random_direction(rng);
    const auto moved = [&](const Eigen::VectorXd& dv) {
      return log_so3(exp_so3(v).transpose() * exp_so3(v + Vec3(dv)));
    };
    EXPECT_LT((right_jacobian(v) - numeric_jacobian(moved, Vec3::Zero(), 1e-5)).norm(), 1e-9) << length;
  }
}

TEST(Rotation, RotationTimesRightJacobianIsTheLeftJacobian) {
  // exp(v) J_r(v) = J_r(−v), exactly; and v is its own image.
  for (const Vec3& v : rotation_vectors()) {
    EXPECT_LT((exp_so3(v) * right_jacobian(v) - right_jacobian(-v)).norm(), 2e-15 + 1e-15 * v.norm()) << v.norm();
    EXPECT_LE((right_jacobian(v) * v - v).norm(), 2e-15 * v.norm());
  }
}

TEST(Rotation, InverseOfTheRightJacobianIsItsInverse) {
  for (const Vec3& v : rotation_vectors())
    EXPECT_LT((right_jacobian(v) * right_jacobian_inverse(v) - Mat3::Identity()).norm(), 1e-14) << v.norm();
}

TEST(Rpy, IsYawAboutZThenPitchAboutYThenRollAboutX) {
  const Mat3 r = from_rpy({0.1, 0.2, 0.3});
  EXPECT_LT((r - exp_so3(0.3 * Vec3::UnitZ()) * exp_so3(0.2 * Vec3::UnitY()) * exp_so3(0.1 * Vec3::UnitX())).norm(),
            1e-15);
  EXPECT_LT((to_rpy(r) - Vec3(0.1, 0.2, 0.3)).norm(), 1e-15);
}

TEST(Rpy, RoundTripKeepsTheRotationAlsoNearAndAtTheGimbalLock) {
  Rng rng(5);
  for (const double off : {1.0, 1e-3, 1e-6, 1e-8, 1e-9, 1e-10, 1e-13, 0.0}) {
    for (const double pitch : {pi / 2 - off, -pi / 2 + off}) {
      for (int i = 0; i < 20; ++i) {
        const Mat3 r = from_rpy({rng.uniform(-3, 3), pitch, rng.uniform(-3, 3)});
        EXPECT_LT((from_rpy(to_rpy(r)) - r).norm(), 2e-12) << "pitch " << pitch;
      }
    }
  }
}

TEST(Rpy, RollIsZeroAtTheGimbalLock) {
  const Vec3 up = to_rpy(from_rpy({0.3, pi / 2, 1.0})), down = to_rpy(from_rpy({0.3, -pi / 2, 1.0}));
  EXPECT_LT((up - Vec3(0, pi / 2, 0.7)).norm(), 1e-15);
  EXPECT_LT((down - Vec3(0, -pi / 2, 1.3)).norm(), 1e-15);
}

TEST(Euler, EverySequenceIsTheProductOfItsRotations) {
  const Vec3 angles(0.4, -1.1, 2.3);
  const auto rotation_about = [&](char axis, double angle) { return exp_so3(angle * Vec3::Unit(axis - 'X')); };
  int sequences = 0;
  for (const char a : {'X', 'Y', 'Z'}) {
    for (const char b : {'X', 'Y', 'Z'}) {
      for (const char c : {'X', 'Y', 'Z'}) {
        const std::string axes{a, b, c};
        const auto intrinsic = parse_euler_sequence(axes + " intrinsic"),
                   extrinsic = parse_euler_sequence(axes + " extrinsic");
        EXPECT_EQ(intrinsic.has_value(), a != b && b != c) << axes;
        if (!intrinsic) continue;
        ++sequences;
        const Mat3 first = rotation_about(a, angles[0]), second = rotation_about(b, angles[1]),
                   third = rotation_about(c, angles[2]);
        EXPECT_LT((from_euler(*intrinsic, angles) - first * second * third).norm(), 1e-15) << axes;
        EXPECT_LT((from_euler(*extrinsic, angles) - third * second * first).norm(), 1e-15) << axes;
      }
    }
  }
  EXPECT_EQ(sequences, 12);
}

TEST(Euler, RollPitchYawIsXyzExtrinsic) {
  EXPECT_LT((from_euler(*parse_euler_sequence("xyz extrinsic"), {0.1, 0.2, 0.3}) - from_rpy({0.1, 0.2, 0.3})).norm(),
            1e-16);
}

TEST(Euler, OtherTextsAreNoSequence) {
  for (const char* text :
       {"", "XY", "XYZ", "XYW intrinsic", "XXY intrinsic", "XYZ fixed", "XYZintrinsic", "XYZ intrinsic "})
    EXPECT_FALSE(parse_euler_sequence(text).has_value()) << text;
}

TEST(AnyPerpendicular, IsAUnitVectorAcross) {
  Rng rng(7);
  for (int i = 0; i < 20; ++i) {
    const Vec3 v = i < 3 ? Vec3(1e-6 * Vec3::Unit(i)) : Vec3(100 * random_direction(rng)),
               across = any_perpendicular(v);
    EXPECT_NEAR(across.norm(), 1.0, 1e-15);
    EXPECT_LT(std::abs(across.dot(v)), 1e-15 * v.norm());
  }
}

TEST(RotationBetween, TurnsOneDirectionIntoTheOtherByTheAngleBetweenThem) {
  Rng rng(8);
  for (int i = 0; i < 50; ++i) {
    const Vec3 from = 3.0 * random_direction(rng), to = 0.2 * random_direction(rng);
    const Quat turn = rotation_between(from, to);
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-14);
    EXPECT_NEAR(quat_log(turn).norm(), angle_between(from, to), 1e-13);
  }
}

TEST(RotationBetween, TurnsOppositeDirectionsIntoEachOther) {
  for (const double off : {0.0, 1e-12, 1e-9, 1e-7, 1e-6, 3e-6, 1e-4, 2e-4, 1e-3}) {
    const Vec3 from(0.6, 0.0, 0.8), to = -(exp_so3(Vec3(0.0, off, 0.0)) * from);
    const Quat turn = rotation_between(from, to);
    EXPECT_NEAR(turn.norm(), 1.0, 1e-7) << off;
    EXPECT_LT((turn * from - to).norm(), 1e-7) << off;
    EXPECT_NEAR(quat_log(turn).norm(), pi, off + 1e-7);
  }
}

TEST(AngleBetween, IsAccurateForTinyRightAndStraightAngles) {
  for (const double angle : {0.0, 1e-12, 1e-6, 1.0, pi / 2, pi - 1e-6}) {
    EXPECT_NEAR(angle_between(Vec3(2, 0, 0), Vec3(std::cos(angle), std::sin(angle), 0)), angle, 1e-15 + 1e-15 * angle);
    EXPECT_NEAR(angle_between(rot_x(0.3), Mat3(rot_x(0.3) * rot_y(angle))), angle, 1e-15);
  }
}

TEST(Pose, ChainsAndInvertsLikeTheFourByFourMatrix) {
  const auto matrix = [](const Pose& pose) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = pose.rotation;
    m.topRightCorner<3, 1>() = pose.position;
    return m;
  };
  const Pose a = Pose::from_xyz_rpy({1, 2, 3}, {0.1, 0.2, 0.3}), b = Pose::from_xyz_rpy({-1, 0, 2}, {1, -1, 2});
  EXPECT_LT((matrix(a * b) - matrix(a) * matrix(b)).norm(), 1e-15);
  EXPECT_LT((matrix(a.inverse()) * matrix(a) - Eigen::Matrix4d::Identity()).norm(), 1e-15);
  EXPECT_LT((a * Vec3(4, 5, 6) - (matrix(a) * Eigen::Vector4d(4, 5, 6, 1)).head<3>()).norm(), 2e-15);
}

}  // namespace
}  // namespace kinfer
