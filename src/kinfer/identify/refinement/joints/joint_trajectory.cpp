// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/joints/joint_trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

constexpr std::size_t max_trajectory_frames = 600;  // enough for a smooth animation of a minute

MatrixXd spline_values(const SplineGrid& grid, ConstMatrixRef coefficients, std::span<const double> times) {
  MatrixXd values(coefficients.rows(), static_cast<Index>(times.size()));
  for (std::size_t i = 0; i < times.size(); ++i)
    values.col(static_cast<Index>(i)) = spline_value(grid, coefficients, times[i]);
  return values;
}

/// parent_R_child behind the last joint of the bodies is this times a constant.
Mat3 rotation_from_vector(const VectorXd& vector) {
  return exp_so3(Vec3(vector));
}

MatrixXd spherical_trajectory(const MatrixXd& turns, const Mat3& axes) {
  MatrixXd trajectory(3, turns.cols());
  Vec3 before = Vec3::Zero();
  for (Index i = 0; i < turns.cols(); ++i) {
    before = cardan_angles(axes.transpose() * exp_so3(Vec3(turns.col(i))) * axes, before);
    trajectory.col(i) = before;
  }
  return trajectory;
}

}  // namespace

Binning trajectory_frames(const RecordedMotion& motion) {
  return binning(motion.rows(), max_trajectory_frames);
}

std::vector<double> trajectory_times(const RecordedMotion& motion) {
  std::vector<double> times;
  for (std::size_t row = 0; row < motion.rows(); row += trajectory_frames(motion).size)
    times.push_back(motion.time[row]);
  return times;
}

MatrixXd spherical_rotation_vectors(const SplineGrid& grid, ConstMatrixRef coefficients,
                                    std::span<const double> times) {
  const Mat3 home = rotation_from_vector(spline_value(grid, coefficients, grid.begin));
  MatrixXd turns = spline_values(grid, coefficients, times);
  for (Index i = 0; i < turns.cols(); ++i)
    turns.col(i) = log_so3(rotation_from_vector(turns.col(i)) * home.transpose());
  return turns;
}

Mat3 spherical_axes(ConstMatrixRef turns) {
  const SymmetricEigen eigen = symmetric_eigen(times_transposed(turns, turns));
  Mat3 axes;
  axes.col(0) = eigen.vectors.col(2);
  axes.col(1) = eigen.vectors.col(0);
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

MatrixXd joint_trajectory(EstimatedJointType type, std::span<const InsBody> bodies, const JointGeometry& geometry,
                          std::span<const double> zero, const SplineGrid& grid, ConstMatrixRef coefficients,
                          std::span<const double> times) {
  if (type == EstimatedJointType::rigid) return {};
  if (type == EstimatedJointType::spherical)
    return spherical_trajectory(spherical_rotation_vectors(grid, coefficients, times), geometry.spherical_axes);
  MatrixXd trajectory = spline_values(grid, coefficients, times);
  for (Index k = 0; k < trajectory.rows(); ++k) trajectory.row(k).array() -= zero[static_cast<std::size_t>(k)];
  if (bodies.size() == 1 && geometry.axis_in_parent.dot(bodies.front().parent_R_axis.col(2)) < 0.0)
    trajectory = -trajectory;
  return trajectory;
}

}  // namespace kinfer::identify
