// SPDX-License-Identifier: Apache-2.0
// Direction of the tool point from a station with the pose (R, s) in the world. With d = Rᵀ (p − s), u = d / |d|, the
// measured unit vector m and two unit vectors B across m, the residual is −(θ / sin θ) Bᵀ u, where θ is the angle from
// m to u: its norm is θ up to the opposite direction.
//
// du = (I − u uᵀ) / |d| · dd, dd = Rᵀ dp − Rᵀ ds + d × dφ for R exp(dφ).
#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

namespace kinfer {
namespace {

constexpr FixtureKind station_kind = fixture_kind("station");

/// θ / sin θ and its derivative by cos θ.
struct AngleFactor {
  double value = 1.0, slope = -1.0 / 3.0;
};

AngleFactor angle_factor(double sine, double cosine) {
  const double angle = std::atan2(sine, cosine);
  if (angle < 1e-3) return {1.0 + angle * angle / 6.0, -1.0 / 3.0 - 2.0 / 15.0 * angle * angle};
  const double limited = std::max(sine, 1e-6);  // at the opposite direction
  return {angle / limited, (angle * cosine / limited - 1.0) / (limited * limited)};
}

/// Columns: axes about which rx, ry and rz turn the frame, in the frame itself.
Mat3 rotation_axes(const Frame& frame) {
  const Mat3 about_z = rot_z(frame.small_rotation.z()), about_yz = rot_y(frame.small_rotation.y()) * about_z;
  Mat3 axes;
  axes << about_yz.row(0).transpose(), about_z.row(1).transpose(), Vec3::UnitZ();
  return axes;
}

void direction_residual(const ResidualContext& scene, std::size_t index, BlockRows& out) {
  const DirectionMeasurement& measured = scene.data.directions[index];
  const Frame& frame = scene.chain.fixtures.stations[measured.station].frame;
  const Mat3 station_R_world = frame.pose().rotation.transpose();
  const Vec3 sight = station_R_world * (scene.at.pose[measured.row].position - frame.xyz);
  const double range = std::max(sight.norm(), 1e-9);  // [m] at the station any direction is valid
  const Vec3 predicted = sight / range;
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = any_perpendicular(measured.direction);
  across.col(1) = measured.direction.cross(across.col(0));
  const AngleFactor factor =
      angle_factor(measured.direction.cross(predicted).norm(), measured.direction.dot(predicted));
  const Eigen::Vector2d offset = across.transpose() * predicted;
  out.residuals.segment<2>(out.row) = -factor.value * offset;
  if (!out.jacobian) return;
  const Eigen::Matrix<double, 2, 3> by_predicted =
      -factor.value * across.transpose() - factor.slope * offset * measured.direction.transpose();
  const Eigen::Matrix<double, 2, 3> by_sight =
      by_predicted * (Mat3::Identity() - predicted * predicted.transpose()) / range;
  const Eigen::Matrix<double, 2, 3> by_point = by_sight * station_R_world;
  const Eigen::Matrix<double, 2, 3> by_rotation = by_sight * skew(sight) * rotation_axes(frame);
  auto rows = out.jacobian->middleRows<2>(out.row);
  rows = by_point * scene.at.twists[measured.row].topRows<3>();
  const FixtureColumns::Numbers& columns = scene.columns.of(station_kind, measured.station);
  for (int k = 0; k < 3; ++k) {
    if (columns[k] >= 0) rows.col(columns[k]) = -by_point.col(k);
    if (columns[3 + k] >= 0) rows.col(columns[3 + k]) = by_rotation.col(k);
  }
}

double range_of(const ResidualContext& scene, std::size_t index) {
  const DirectionMeasurement& measured = scene.data.directions[index];
  return (scene.at.pose[measured.row].position - scene.chain.fixtures.stations[measured.station].frame.xyz).norm();
}

}  // namespace

template <>
ResidualModel residual_model<DirectionMeasurement>() {
  return {.write = direction_residual, .metres = range_of};
}

}  // namespace kinfer
