// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/universal_axes.hpp"

#include <cmath>
#include <numeric>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/identify/structure/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;
using Rows9 = Eigen::Matrix<double, 3, 9>;

/// Mean of the rotations and the second moments of their entries about it, column by column.
struct RotationMoments {
  Mat3 mean = Mat3::Zero();
  Mat9 of_entries = Mat9::Zero();
};

RotationMoments rotation_moments(const std::vector<Mat3>& rotations) {
  RotationMoments moments;
  const auto n = static_cast<double>(rotations.size());
  for (const Mat3& rotation : rotations) moments.mean += rotation / n;
  for (const Mat3& rotation : rotations) {
    const Mat3 difference = rotation - moments.mean;
    const Eigen::Map<const Vec9> entries(difference.data());
    moments.of_entries += entries * entries.transpose() / n;
  }
  return moments;
}

/// Second moment of Dᵀ axis over the differences D of the rotations from their mean.
Mat3 moment_in_child(const RotationMoments& moments, const Vec3& axis) {
  Rows9 of_columns = Rows9::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) of_columns.block<1, 3>(k, 3 * k) = axis.transpose();
  return of_columns * moments.of_entries * of_columns.transpose();
}

/// Likewise of D axis.
Mat3 moment_in_parent(const RotationMoments& moments, const Vec3& axis) {
  Rows9 of_columns;
  for (Eigen::Index k = 0; k < 3; ++k) of_columns.block<3, 3>(0, 3 * k) = axis[k] * Mat3::Identity();
  return of_columns * moments.of_entries * of_columns.transpose();
}

/// The direction δ + t m, m: that of the other axis, δ ⊥ m of unit length, with the least variance of the angle. A gain
/// below the size of errors inclines the axes no further.
Vec3 least_varying_axis(const Mat3& moment, const Vec3& other) {
  const Vec3 m = other.normalized();
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = any_perpendicular(m);
  across.col(1) = m.cross(across.col(0));
  const Eigen::RowVector2d mixed = m.transpose() * moment * across;
  const double along = m.dot(moment * m) + orientation_error.median * orientation_error.median;
  const Eigen::Matrix2d of_delta = across.transpose() * moment * across - mixed.transpose() * mixed / along;
  const Eigen::Vector2d delta = symmetric_eigen(of_delta).vectors.col(0);
  return (across * delta - m * (mixed.dot(delta) / along)).normalized();
}

void measure_angle(UniversalAxes& axes, const std::vector<Mat3>& rotations) {
  const auto n = static_cast<double>(rotations.size());
  std::vector<double> angles;
  for (const Mat3& rotation : rotations) angles.push_back(angle_between(axes.in_parent, rotation * axes.in_child));
  axes.angle = std::accumulate(angles.begin(), angles.end(), 0.0) / n;
  double square = 0.0;
  for (const double angle : angles) square += (angle - axes.angle) * (angle - axes.angle) / n;
  axes.deviation = std::sqrt(square);
}

UniversalAxes axes_from(const RotationMoments& moments, const std::vector<Mat3>& rotations, const Vec3& start) {
  constexpr int rounds = 30;
  UniversalAxes axes{.in_parent = start};
  for (int round = 0; round < rounds; ++round) {
    axes.in_child =
        least_varying_axis(moment_in_child(moments, axes.in_parent), moments.mean.transpose() * axes.in_parent);
    axes.in_parent = least_varying_axis(moment_in_parent(moments, axes.in_child), moments.mean * axes.in_child);
  }
  measure_angle(axes, rotations);
  return axes;
}

/// Axes in any directions are inclined by β with the density sin β: nearly parallel ones need a smaller deviation.
double inclined_deviation(const UniversalAxes& axes) {
  return std::hypot(axes.deviation, orientation_error.median) / std::sin(axes.angle);
}

}  // namespace

UniversalAxes universal_axes(const std::vector<Mat3>& rotations, const Mat3& starts) {
  const RotationMoments moments = rotation_moments(rotations);
  UniversalAxes best = axes_from(moments, rotations, starts.col(0));
  for (Eigen::Index k = 1; k < 3; ++k)
    if (const UniversalAxes other = axes_from(moments, rotations, starts.col(k));
        inclined_deviation(other) < inclined_deviation(best))
      best = other;
  return best;
}

}  // namespace kinfer::identify
