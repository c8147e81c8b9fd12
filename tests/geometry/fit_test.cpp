// SPDX-License-Identifier: Apache-2.0
#include "kinfer/geometry/fit.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/random.hpp"

namespace kinfer {
namespace {

using std::numbers::pi;

std::vector<Vec3> cloud(int count, const Vec3& size, Rng rng) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back(size.cwiseProduct(normal_vector(rng)));
  return points;
}

std::vector<Vec3> moved(const Pose& pose, const std::vector<Vec3>& points) {
  std::vector<Vec3> result;
  for (const Vec3& p : points) result.push_back(pose * p);
  return result;
}

double misfit(const Pose& pose, const std::vector<Vec3>& a, const std::vector<Vec3>& b, const std::vector<double>& w) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += w[i] * (a[i] - pose * b[i]).squaredNorm();
  return sum;
}

const Pose far_away = Pose::from_xyz_rpy({100, -50, 3}, {2.5, -0.4, -3.0});

TEST(AlignPoints, RecoversThePoseFromPointsInSpaceAndInAPlane) {
  for (const Vec3& size : {Vec3(1, 2, 3), Vec3(1, 2, 0), Vec3(0, 1, 1)}) {
    const auto b = cloud(10, size, Rng(1));
    const Pose pose = align_points(moved(far_away, b), b);
    EXPECT_LT((pose.rotation - far_away.rotation).norm(), 1e-13) << size.transpose();
    EXPECT_LT((pose.position - far_away.position).norm(), 1e-12) << size.transpose();
  }
}

TEST(AlignPoints, RecoversHalfTurnsAndTheIdentity) {
  const auto b = cloud(5, {1, 1, 1}, Rng(2));
  for (const Vec3& turn : {Vec3(0, 0, 0), Vec3(pi, 0, 0), Vec3(0, pi, 0), Vec3(0, 0, pi)}) {
    const Pose truth{exp_so3(turn), Vec3(1, 2, 3)};
    EXPECT_LT((align_points(moved(truth, b), b).rotation - truth.rotation).norm(), 1e-13);
  }
}

TEST(AlignPoints, NeverAnswersWithAReflection) {
  // A mirrored cloud would be fitted best by a reflection.
  for (int seed = 0; seed < 20; ++seed) {
    const auto b = cloud(8, {1, 1, seed % 2 == 0 ? 1.0 : 1e-3}, Rng(seed));
    auto mirrored = b;
    for (Vec3& p : mirrored) p.z() = -p.z();
    const Mat3 r = align_points(mirrored, b).rotation;
    EXPECT_NEAR(r.determinant(), 1.0, 1e-14);
    EXPECT_LT((r * r.transpose() - Mat3::Identity()).norm(), 1e-14);
  }
}

TEST(AlignPoints, NoSmallRotationOrShiftFitsNoisyWeightedPointsBetter) {
  const auto b = cloud(20, {1, 1, 1}, Rng(3)), noise = cloud(20, {0.05, 0.05, 0.05}, Rng(4));
  auto a = moved(far_away, b);
  std::vector<double> weights;
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += noise[i], weights.push_back(0.1 + static_cast<double>(i % 4));
  const Pose best = align_points(a, b, weights);
  const double least = misfit(best, a, b, weights);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-1e-4, 1e-4}) {
      const Pose turned{best.rotation * exp_so3(step * Vec3::Unit(axis)), best.position};
      const Pose shifted{best.rotation, best.position + step * Vec3::Unit(axis)};
      EXPECT_GT(misfit(turned, a, b, weights), least);
      EXPECT_GT(misfit(shifted, a, b, weights), least);
    }
  }
}

TEST(AlignPoints, APointWithoutWeightDoesNotCount) {
  const auto b = cloud(6, {1, 1, 1}, Rng(5));
  auto a = moved(far_away, b);
  a[2] += Vec3(10, 0, 0);
  const Pose pose = align_points(a, b, std::vector<double>{1, 1, 0, 1, 1, 1});
  EXPECT_LT((pose.rotation - far_away.rotation).norm(), 1e-12);
}

TEST(MeanRotation, OfRotationsAboutOneAxisIsTheMeanAngle) {
  const std::vector<Mat3> turns{rot_z(0.2), rot_z(0.4), rot_z(0.6)};
  EXPECT_LT((mean_rotation(turns) - rot_z(0.4)).norm(), 1e-14);
  const std::vector<Mat3> across_pi{rot_z(pi - 0.1), rot_z(-pi + 0.1)};
  EXPECT_LT((mean_rotation(across_pi) - rot_z(pi)).norm(), 1e-14);
}

TEST(FitPlane, FindsThePlaneAndTheDistancesOfPointsBesideIt) {
  std::vector<Vec3> points;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      for (const double side : {-0.1, 0.1}) points.push_back(far_away * Vec3(i, j, side));
  const PlaneFit plane = fit_plane(points);
  EXPECT_LT(plane.normal.cross(far_away.rotation.col(2)).norm(), 1e-12);
  EXPECT_NEAR(plane.normal.norm(), 1.0, 1e-14);
  EXPECT_LT((plane.point - far_away.position).norm(), 1e-12);
  EXPECT_NEAR(plane.rms, 0.1, 1e-12);
}

std::vector<Vec3> arc(double radius, double from, double to, int count) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double angle = from + (to - from) * i / (count - 1);
    points.push_back(far_away * Vec3(radius * std::cos(angle), radius * std::sin(angle), 0));
  }
  return points;
}

TEST(FitCircle, ThreePointsGiveTheCircleThroughThem) {
  const CircleFit circle = fit_circle(arc(2.0, 0.3, 2.0, 3));
  EXPECT_LT((circle.center - far_away.position).norm(), 1e-11);
  EXPECT_NEAR(circle.radius, 2.0, 1e-11);
  EXPECT_LT(circle.rms, 1e-12);
}

TEST(FitCircle, TheNormalPointsByTheRightHandFromTheFirstPointToTheLaterOnes) {
  const Vec3 up = far_away.rotation.col(2);
  for (const double end : {0.5, 2.0, 4.0, 6.0}) {
    EXPECT_LT((fit_circle(arc(1.5, 0.0, end, 30)).normal - up).norm(), 1e-10) << end;
    EXPECT_LT((fit_circle(arc(1.5, 0.0, -end, 30)).normal + up).norm(), 1e-10) << end;
  }
}

TEST(FitCircle, AShortArcStillGivesTheCenter) {
  const CircleFit circle = fit_circle(arc(1.0, 0.0, 0.1, 20));
  EXPECT_LT((circle.center - far_away.position).norm(), 1e-7);  // the arc's height is 1e-3, the points' rounding 1e-14
  EXPECT_NEAR(circle.radius, 1.0, 1e-7);
}

TEST(FitCircle, MinimisesTheDistancesAndNotTheirSquaresAlgebraicForm) {
  // Two rings of points at 1 ± 0.1, rotated against each other: the geometric fit has radius 1 and rms 0.1 exactly.
  std::vector<Vec3> points;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2 * pi * i / 24, radius = i % 2 == 0 ? 1.1 : 0.9;
    points.push_back(far_away * Vec3(radius * std::cos(angle), radius * std::sin(angle), 0));
  }
  const CircleFit circle = fit_circle(points);
  EXPECT_NEAR(circle.radius, 1.0, 1e-12);
  EXPECT_NEAR(circle.rms, 0.1, 1e-12);
  EXPECT_LT((circle.center - far_away.position).norm(), 1e-12);
}

TEST(FitCircle, HeightAboveThePlaneCountsInTheRms) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) {
    const double angle = 2 * pi * i / 8;
    points.push_back({std::cos(angle), std::sin(angle), i % 2 == 0 ? 0.1 : -0.1});
  }
  EXPECT_NEAR(fit_circle(points).rms, 0.1, 1e-12);
}

TEST(RmsSpread, IsAboutTheCentroidAndDoesNotMove) {
  const std::vector<Vec3> points{{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 2.0, 0.0}, {0.0, -2.0, 0.0}};
  EXPECT_NEAR(rms_spread(points), std::sqrt(2.5), 1e-15);
  EXPECT_NEAR(rms_spread(moved({Mat3::Identity(), Vec3(100.0, 0.0, 0.0)}, points)), std::sqrt(2.5), 1e-12);
  EXPECT_EQ(centroid(points), Vec3(0.0, 0.0, 0.0));
}

}  // namespace
}  // namespace kinfer
