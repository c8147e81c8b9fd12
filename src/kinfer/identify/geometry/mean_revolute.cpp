// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/geometry/mean_revolute.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

struct AxisPair {
  Vec3 in_parent, in_child;
};

AxisPair mean_axes(std::span<const Mat3> rotations) {
  Mat3 mean = Mat3::Zero();
  for (const Mat3& r : rotations) mean += r / static_cast<double>(rotations.size());
  const Vec3 b = symmetric_eigen(mean.transpose() * mean).vectors.col(2);
  return {(mean * b).normalized(), b};
}

/// Variance of one axis in the other's frame, in the two directions across it.
std::array<double, 2> axis_variance(std::span<const Mat3> rotations, const Mat3& frame, const Vec3& other,
                                    bool in_parent) {
  std::array<double, 2> variance{};
  for (Index k = 0; k < 2; ++k) {
    std::vector<double> offset;
    double square = 0.0;
    for (const Mat3& r : rotations) {
      offset.push_back(frame.col(k).dot(in_parent ? Vec3(r * other) : Vec3(r.transpose() * other)));
      square += offset.back() * offset.back();
    }
    variance[static_cast<std::size_t>(k)] = square / static_cast<double>(rotations.size()) / effective_samples(offset);
  }
  return variance;
}

/// Lag [samples] at which the autocorrelation of a series falls to 1/e: a first-order Gauss-Markov process' correlation
/// time. The lag-one correlation would tell that of a smooth motion only in units of the sampling.
double correlation_length(const std::vector<double>& series) {
  constexpr double limit = 1.0 / std::numbers::e;
  const double middle = mean(series);
  const auto covariance_at = [&](std::size_t lag) {
    double sum = 0.0;
    for (std::size_t i = lag; i < series.size(); ++i) sum += (series[i] - middle) * (series[i - lag] - middle);
    return sum / static_cast<double>(series.size());
  };
  const double variance = covariance_at(0);
  double before = 1.0;
  for (std::size_t lag = 1; variance > 0.0 && lag < series.size() / 2; ++lag) {
    const double now = covariance_at(lag) / variance;
    if (now < limit) return static_cast<double>(lag) - (limit - now) / (before - now);
    before = now;
  }
  return 0.0;
}

/// Of the child's axis across the parent's, mean of both directions.
double deviation_memory_of(std::span<const Mat3> rotations, const Mat3& frame, const Vec3& in_child) {
  double memory = 0.0;
  for (Index k = 0; k < 2; ++k) {
    std::vector<double> offset;
    for (const Mat3& r : rotations) offset.push_back(frame.col(k).dot(r * in_child));
    memory += 0.5 * correlation_length(offset);
  }
  return memory;
}

double axis_deviation_of(std::span<const Mat3> rotations, const AxisPair& axes) {
  double square = 0.0;
  for (const Mat3& r : rotations) {
    const double angle = std::acos(std::clamp(axes.in_parent.dot(r * axes.in_child), -1.0, 1.0));
    square += angle * angle / static_cast<double>(rotations.size());
  }
  return std::sqrt(square);
}

double revolute_position(const InsBody& revolute, const Mat3& rotation) {
  const Mat3 rotation_about_axis = revolute.parent_R_axis.transpose() * rotation * revolute.child_R_axis;
  return std::atan2(rotation_about_axis(1, 0) - rotation_about_axis(0, 1),
                    rotation_about_axis(0, 0) + rotation_about_axis(1, 1));
}

/// Covariance of a point whose frame has small rotation errors of this variance about any axis.
Mat3 rotated_point_covariance(const Vec3& point, double variance) {
  return variance * (point.squaredNorm() * Mat3::Identity() - point * point.transpose());
}

}  // namespace

MeanRevolute fit_mean_revolute(const InsBody& spherical, std::span<const Mat3> rotations, ConstMatrixRef points,
                               double misalignment) {
  const AxisPair axes = mean_axes(rotations);
  const Mat3 a = frame_with_z_along(axes.in_parent), b = frame_with_z_along(axes.in_child);
  MeanRevolute revolute{revolute_body(spherical.parent, spherical.sensor, a, b), 0.0,
                        axis_deviation_of(rotations, axes), MatrixXd::Zero(10, 10),
                        deviation_memory_of(rotations, a, axes.in_child)};
  revolute.body.point_in_parent = spherical.point_in_parent;
  revolute.body.point_in_child = spherical.point_in_child;
  revolute.zero = revolute_position(revolute.body, rotations.front());
  // A rotation about x moves the axis along −y, one about y along x.
  const auto in_parent = axis_variance(rotations, a, axes.in_child, true),
             in_child = axis_variance(rotations, b, axes.in_parent, false);
  revolute.covariance.diagonal().head<4>() << in_parent[1], in_parent[0], in_child[1], in_child[0];
  revolute.covariance.diagonal().head<4>().array() += misalignment * misalignment;
  revolute.covariance.bottomRightCorner<6, 6>() = points;
  // The same rotation of the sensor relative to its segment also moves the joint's point in the sensor.
  revolute.covariance.block<3, 3>(4, 4) +=
      rotated_point_covariance(spherical.point_in_parent, 0.5 * (in_parent[0] + in_parent[1]));
  revolute.covariance.block<3, 3>(7, 7) +=
      rotated_point_covariance(spherical.point_in_child, 0.5 * (in_child[0] + in_child[1]));
  return revolute;
}

MatrixXd revolute_trajectory(const MeanRevolute& revolute, std::span<const Mat3> rotations) {
  MatrixXd trajectory(1, static_cast<Index>(rotations.size()));
  double before = 0.0;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const double position = revolute_position(revolute.body, rotations[i]) - revolute.zero;
    before += wrap_to_pi(position - before);
    trajectory(0, static_cast<Index>(i)) = before;
  }
  return trajectory;
}

void relax_to_spherical(InsUnknowns& x, const InsLayout& layout, std::size_t body) {
  InsBody& revolute = x.bodies[body];
  // exp(φ) home = A Rz(q) Bᵀ with home = A Rz(middle) Bᵀ: φ = (q − middle) a.
  const VectorXd position = x.spline_coefficients.row(layout.spline_dimension[body]);
  const double middle = 0.5 * (position.minCoeff() + position.maxCoeff());
  InsBody spherical = spherical_body(revolute.parent, revolute.sensor,
                                     revolute.parent_R_axis * rot_z(middle) * revolute.child_R_axis.transpose());
  spherical.point_in_parent = revolute.point_in_parent;
  spherical.point_in_child = revolute.point_in_child;
  const Index at = layout.spline_dimension[body], after = x.spline_coefficients.rows() - at - 1;
  MatrixXd coefficients(x.spline_coefficients.rows() + 2, x.spline_coefficients.cols());
  coefficients.topRows(at) = x.spline_coefficients.topRows(at);
  coefficients.middleRows<3>(at) = revolute.parent_R_axis.col(2) * (position.array() - middle).matrix().transpose();
  coefficients.bottomRows(after) = x.spline_coefficients.bottomRows(after);
  revolute = spherical;
  x.spline_coefficients = std::move(coefficients);
}

}  // namespace kinfer::identify
