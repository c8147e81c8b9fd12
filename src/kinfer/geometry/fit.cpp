// SPDX-License-Identifier: Apache-2.0
#include "kinfer/geometry/fit.hpp"

#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {

Vec3 centroid(std::span<const Vec3> points, std::span<const double> weights) {
  Vec3 sum = Vec3::Zero();
  double total = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double w = weights.empty() ? 1.0 : weights[i];
    sum += w * points[i];
    total += w;
  }
  return sum / total;
}

double rms_spread(std::span<const Vec3> points) {
  const Vec3 center = centroid(points);
  double squares = 0.0;
  for (const Vec3& p : points) squares += (p - center).squaredNorm();
  return std::sqrt(squares / static_cast<double>(points.size()));
}

namespace {

SymmetricEigen principal_axes(std::span<const Vec3> points, const Vec3& center) {
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& p : points) scatter += (p - center) * (p - center).transpose();
  return symmetric_eigen(scatter);
}

/// Rotation that maximises tr(Rᵀ h): the eigenvector of Horn's 4x4 matrix (Horn 1987, section 3).
Mat3 best_rotation(const Mat3& h) {
  Eigen::Matrix4d n;
  const Vec3 skewed(h(2, 1) - h(1, 2), h(0, 2) - h(2, 0), h(1, 0) - h(0, 1));
  n(0, 0) = h.trace();
  n.block<1, 3>(0, 1) = skewed.transpose();
  n.block<3, 1>(1, 0) = skewed;
  n.block<3, 3>(1, 1) = h + h.transpose() - h.trace() * Mat3::Identity();
  const VectorXd q = symmetric_eigen(n).vectors.col(3);
  return Quat(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

}  // namespace

Pose align_points(std::span<const Vec3> a, std::span<const Vec3> b, std::span<const double> weights) {
  KINFER_EXPECT(a.size() == b.size() && !a.empty(), "{} and {} points", a.size(), b.size());
  const Vec3 center_a = centroid(a, weights), center_b = centroid(b, weights);
  Mat3 h = Mat3::Zero();
  for (std::size_t i = 0; i < a.size(); ++i)
    h += (weights.empty() ? 1.0 : weights[i]) * (a[i] - center_a) * (b[i] - center_b).transpose();
  const Mat3 rotation = best_rotation(h);
  return {rotation, center_a - rotation * center_b};
}

Mat3 mean_rotation(std::span<const Mat3> rotations) {
  KINFER_EXPECT(!rotations.empty());
  Mat3 sum = Mat3::Zero();
  for (const Mat3& r : rotations) sum += r;
  return best_rotation(sum);
}

PlaneFit fit_plane(std::span<const Vec3> points) {
  KINFER_EXPECT(points.size() >= 3, "{} points", points.size());
  PlaneFit fit;
  fit.point = centroid(points);
  const SymmetricEigen axes = principal_axes(points, fit.point);
  fit.normal = axes.vectors.col(0);
  fit.rms = std::sqrt(std::max(0.0, axes.values[0]) / static_cast<double>(points.size()));
  return fit;
}

CircleFit fit_circle(std::span<const Vec3> points) {
  const PlaneFit plane = fit_plane(points);
  const auto n = static_cast<Eigen::Index>(points.size());
  const Vec3 u = any_perpendicular(plane.normal), v = plane.normal.cross(u);
  MatrixXd flat(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) flat.row(i) << u.dot(points[i] - plane.point), v.dot(points[i] - plane.point);

  // Kåsa: x² + y² = 2 cx x + 2 cy y + k is linear in (cx, cy, k).
  MatrixXd a(n, 3);
  a << 2.0 * flat, VectorXd::Ones(n);
  const VectorXd start = solve_least_squares(a, flat.rowwise().squaredNorm());
  Eigen::Vector2d c = start.head<2>();
  double radius = std::sqrt(std::max(0.0, start[2] + c.squaredNorm()));
  for (int pass = 0; pass < 20; ++pass) {
    MatrixXd jacobian(n, 3);
    VectorXd residual(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Vector2d from_center = flat.row(i).transpose() - c;
      const double distance = from_center.norm();
      residual[i] = distance - radius;
      jacobian.row(i) << from_center.transpose() / distance, 1.0;
    }
    const VectorXd step = solve_least_squares(jacobian, residual);
    c += step.head<2>();
    radius += step[2];
    if (step.norm() < 1e-14 * (1.0 + radius)) break;
  }

  CircleFit fit{plane.point + c.x() * u + c.y() * v, plane.normal, radius, 0.0};
  double signed_area = 0.0, squares = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3 from_center = points[i] - fit.center;
    const double height = fit.normal.dot(from_center);
    squares += height * height + std::pow((from_center - height * fit.normal).norm() - radius, 2);
    if (i > 0) signed_area += fit.normal.dot((points[i - 1] - fit.center).cross(from_center));
  }
  if (signed_area < 0.0) fit.normal = -fit.normal;
  fit.rms = std::sqrt(squares / static_cast<double>(n));
  return fit;
}

}  // namespace kinfer
