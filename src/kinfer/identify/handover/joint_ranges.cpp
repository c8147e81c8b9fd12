// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/joint_ranges.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

double middle_of(const SplineGrid& grid, Index interval) {
  return grid.begin + grid.period * (static_cast<double>(interval) + 0.5);
}

/// Derivative `order` of all splines at the middle of each interval: dimensions x intervals.
MatrixXd derivatives(const SplineGrid& grid, ConstMatrixRef splines, int order) {
  MatrixXd values(splines.rows(), grid.intervals);
  for (Index k = 0; k < grid.intervals; ++k) values.col(k) = spline_value(grid, splines, middle_of(grid, k), order);
  return values;
}

double rms(const VectorXd& values) {
  return values.size() > 0 ? values.norm() / std::sqrt(static_cast<double>(values.size())) : 0.0;
}

}  // namespace

MatrixXd joint_splines(const InsFit& fit, const JointBodies& joint) {
  Index rows = 0;
  for (std::size_t b = joint.first; b <= joint.last; ++b) rows += degrees_of_freedom(fit.unknowns.bodies[b].motion);
  return rows > 0
             ? MatrixXd(fit.unknowns.spline_coefficients.middleRows(fit.layout.spline_dimension[joint.first], rows))
             : MatrixXd();
}

std::vector<TrackingRange> joint_ranges(const JointEstimate& joint, const SplineGrid& grid, ConstMatrixRef splines) {
  std::vector<TrackingRange> ranges;
  if (joint.trajectory.size() == 0 || splines.size() == 0) return ranges;
  const MatrixXd speed = derivatives(grid, splines, 1), acceleration = derivatives(grid, splines, 2);
  const bool each = splines.rows() == joint.trajectory.rows() && splines.rows() < 3;
  const double share = std::sqrt(static_cast<double>(joint.trajectory.rows()));
  for (Index k = 0; k < joint.trajectory.rows(); ++k) {
    TrackingRange range{.lower = joint.trajectory.row(k).minCoeff(), .upper = joint.trajectory.row(k).maxCoeff()};
    if (each) {
      range.speed = speed.row(k).cwiseAbs().maxCoeff();
      range.acceleration = rms(acceleration.row(k));
    } else {
      range.speed = speed.colwise().norm().maxCoeff();
      range.acceleration = rms(acceleration.colwise().norm()) / share;
    }
    ranges.push_back(range);
  }
  return ranges;
}

TrackingBase base_motion(const InsProblem& problem, const InsFit& fit) {
  if (problem.root_at_rest) return {.force = fit.unknowns.root_force};
  const MatrixXd rate = fit.unknowns.spline_coefficients.topRows<3>(),
                 force = fit.unknowns.spline_coefficients.middleRows<3>(3);
  const VectorXd norms = derivatives(problem.grid, force, 0).colwise().norm();
  return {.moved = true,
          .angular_acceleration = rms(derivatives(problem.grid, rate, 1).colwise().norm()) / std::sqrt(3.0),
          .acceleration = rms(norms.array() - problem.gravity)};
}

}  // namespace kinfer::identify
