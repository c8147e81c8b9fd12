// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/refined_joints.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/identify/geometry/mean_revolute.hpp"
#include "kinfer/identify/refinement/azimuth.hpp"
#include "kinfer/identify/refinement/joint_trajectory.hpp"
#include "kinfer/identify/refinement/thresholds.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

/// Covariance of a joint's unknowns, body after body, inflated as the residuals require.
MatrixXd joint_covariance(const InsCovariance& covariance, const InsLayout& layout, const InsBodies& bodies,
                          std::size_t first, std::size_t last) {
  const Index begin = layout.body[first], n = layout.body[last] + bodies[last].unknowns() - begin;
  return std::max(1.0, covariance.inflation.segment(begin, n).mean()) * covariance.model.block(begin, begin, n, n);
}

/// Joint positions of the joint's bodies at the beginning of the recording.
std::vector<double> initial_joint_positions(const RefinementSetup& setup, const InsFit& fit, std::size_t first,
                                            std::size_t last) {
  const VectorXd all = spline_value(setup.problem.grid, fit.unknowns.spline_coefficients, setup.problem.grid.begin);
  std::vector<double> positions;
  for (std::size_t b = first; b <= last; ++b)
    for (Index i = 0; i < std::max<Index>(1, degrees_of_freedom(fit.unknowns.bodies[b].motion)); ++i)
      positions.push_back(fit.layout.spline_dimension[b] < 0 ? 0.0 : all[fit.layout.spline_dimension[b] + i]);
  return positions;
}

/// Orientations of a spherical joint in its parent.
std::vector<Mat3> spherical_rotations(const RefinementFit& fitted, std::size_t body, std::span<const double> times) {
  const InsUnknowns& x = fitted.fit.unknowns;
  std::vector<Mat3> rotations;
  for (const double time : times) {
    const VectorXd all = spline_value(fitted.setup.problem.grid, x.spline_coefficients, time);
    rotations.push_back(exp_so3(all.segment<3>(fitted.fit.layout.spline_dimension[body])) *
                        x.bodies[body].child_R_axis.transpose());
  }
  return rotations;
}

std::vector<double> knot_times(const SplineGrid& grid) {
  std::vector<double> times;
  for (Index k = 0; k <= grid.intervals; ++k) times.push_back(grid.begin + grid.period * static_cast<double>(k));
  return times;
}

MatrixXd stacked(const std::vector<MatrixXd>& parts, std::size_t first, std::size_t last) {
  MatrixXd all(0, parts[first].cols());
  for (std::size_t b = first; b <= last; ++b) {
    all.conservativeResize(all.rows() + parts[b].rows(), Eigen::NoChange);
    all.bottomRows(parts[b].rows()) = parts[b];
  }
  return all;
}

/// Spline coefficients of the joint positions, one row a degree of freedom.
MatrixXd joint_spline_coefficients(const InsFit& fit, std::size_t first, std::size_t last) {
  Index rows = 0;
  for (std::size_t b = first; b <= last; ++b) rows += degrees_of_freedom(fit.unknowns.bodies[b].motion);
  return rows > 0 ? MatrixXd(fit.unknowns.spline_coefficients.middleRows(fit.layout.spline_dimension[first], rows))
                  : MatrixXd();
}

/// [rad] Smallest axis deviation of the relaxed revolute joints. What even that joint shows is attributed to compliant
/// mounts, which deflect in phase with the motion, so that it does not average out. 0 where a revolute joint was not
/// relaxed: then the mounts are rigid, too.
double common_axis_deviation(const RefinementTask& task, const RefinementFit& fitted) {
  double smallest = 0.0;
  for (std::size_t i = 0; i < task.starts.size(); ++i) {
    if (task.starts[i].type != EstimatedJointType::revolute) continue;
    const std::size_t body = fitted.setup.first_body[i];
    const InsBody& spherical = fitted.fit.unknowns.bodies[body];
    if (spherical.motion != JointMotion::spherical) return 0.0;
    const auto rotations = spherical_rotations(fitted, body, knot_times(fitted.setup.problem.grid));
    const double axis_deviation = fit_mean_revolute(spherical, rotations, MatrixXd::Zero(6, 6), 0.0).axis_deviation;
    smallest = smallest > 0.0 ? std::min(smallest, axis_deviation) : axis_deviation;
  }
  return smallest;
}

/// Adds to a spherical joint's points (6 x 6) that the sensor frames deflect by `angle` [rad] on their segments.
void add_point_deflection(MatrixXd& covariance, const InsBody& spherical, double angle) {
  covariance.diagonal().head<3>().array() += angle * angle * spherical.point_in_parent.squaredNorm();
  covariance.diagonal().tail<3>().array() += angle * angle * spherical.point_in_child.squaredNorm();
}

/// Adds to a joint's axes that the sensor frames deflect by so much [rad] on their segments.
void add_axis_deflection(MatrixXd& covariance, const InsBody& body, double parent, double child) {
  if (body.motion != JointMotion::revolute && body.motion != JointMotion::prismatic) return;
  covariance.diagonal().head<2>().array() += parent * parent;
  covariance.diagonal().segment<2>(2).array() += child * child;
}

/// A revolute joint that was relaxed to a spherical one in the fit.
RefinedJoint relaxed_joint(const RefinementFit& fitted, std::size_t body, ConstMatrixRef covariance,
                           double mount_deflection, std::span<const double> trajectory_time) {
  const InsProblem& problem = fitted.setup.problem;
  const double misalignment =
      std::hypot(mount_deflection, 0.5 * std::max(problem.prior.gyroscope_scale, problem.prior.accelerometer_scale));
  const MeanRevolute revolute =
      fit_mean_revolute(fitted.fit.unknowns.bodies[body], spherical_rotations(fitted, body, knot_times(problem.grid)),
                        covariance, misalignment);
  RefinedJoint joint =
      refined_joint(EstimatedJointType::revolute, {&revolute.body, 1}, {&revolute.zero, 1}, revolute.covariance);
  joint.axis_deviation = revolute.axis_deviation;
  joint.estimate.trajectory = revolute_trajectory(revolute, spherical_rotations(fitted, body, trajectory_time));
  if (joint.solution.geometry.axis_in_parent.dot(revolute.body.parent_R_axis.col(2)) < 0.0)
    joint.estimate.trajectory *= -1.0;
  return joint;
}

/// One joint with its share of the covariance and of the model's error.
RefinedJoint make_joint(const RefinementTask& task, const RefinementFit& fitted, const InsCovariance& covariance,
                        const ModelError& error, double mount_deflection, std::size_t index,
                        std::span<const double> trajectory_time) {
  const InitialJoint& start = task.starts[index];
  const InsFit& fit = fitted.fit;
  const std::size_t first = fitted.setup.first_body[index], last = fitted.setup.last_body[index];
  const auto bodies = std::span(fit.unknowns.bodies).subspan(first, last - first + 1);
  MatrixXd own = joint_covariance(covariance, fit.layout, fit.unknowns.bodies, first, last);
  if (!error.shift.empty()) {
    const MatrixXd moved = stacked(error.shift, first, last);
    own += times_transposed(moved, moved);
    mount_deflection =
        std::hypot(mount_deflection, error.mount_deflection[start.parent], error.mount_deflection[start.child]);
    add_axis_deflection(own, bodies.front(), error.mount_deflection[start.parent], error.mount_deflection[start.child]);
  }
  if (bodies.front().motion == JointMotion::spherical) add_point_deflection(own, bodies.front(), mount_deflection);
  if (start.type == EstimatedJointType::revolute && bodies.front().motion == JointMotion::spherical)
    return relaxed_joint(fitted, first, own, mount_deflection, trajectory_time);
  const SplineGrid& grid = fitted.setup.problem.grid;
  const MatrixXd coefficients = joint_spline_coefficients(fit, first, last);
  const bool is_spherical = start.type == EstimatedJointType::spherical;
  const Mat3 turning = is_spherical ? spherical_axes(spherical_rotation_vectors(grid, coefficients, trajectory_time))
                                    : Mat3(Mat3::Identity());
  RefinedJoint joint =
      refined_joint(start.type, bodies, initial_joint_positions(fitted.setup, fit, first, last), own, turning);
  joint.estimate.trajectory =
      joint_trajectory(start.type, bodies, joint.solution.geometry, grid, coefficients, trajectory_time);
  if (start.type == EstimatedJointType::revolute && joint.estimate.unobservable_in_child.size() == 1)
    joint.estimate.azimuth_unobservable =
        azimuth_sd(fit.layout, fit.unknowns.bodies, covariance.model, last) > max_azimuth_sd;
  return joint;
}

}  // namespace

std::vector<RefinedJoint> make_joints(const RefinementTask& task, const RefinementFit& fitted,
                                      const InsCovariance& covariance, const ModelError& error) {
  const std::vector<double> trajectory_time = trajectory_times(task.motion);
  const double mount_deflection = common_axis_deviation(task, fitted);
  std::vector<RefinedJoint> joints;
  for (std::size_t i = 0; i < task.starts.size(); ++i) {
    joints.push_back(make_joint(task, fitted, covariance, error, mount_deflection, i, trajectory_time));
    joints.back().estimate.parent = task.motion.segments[task.starts[i].parent].name;
    joints.back().estimate.child = task.motion.segments[task.starts[i].child].name;
  }
  return joints;
}

std::vector<JointEstimate> closing_joints(const InsFit& fit, const InsCovariance& covariance) {
  std::vector<JointEstimate> joints;
  for (std::size_t c = 0; c < fit.unknowns.facts.closures.size(); ++c) {
    const Index begin = fit.layout.closures + closure_unknowns * static_cast<Index>(c);
    const double inflation = std::max(1.0, covariance.inflation.segment<closure_unknowns>(begin).mean());
    const MatrixXd own = inflation * covariance.model.block<closure_unknowns, closure_unknowns>(begin, begin);
    const double zero = 0.0;
    joints.push_back(
        refined_joint(EstimatedJointType::revolute, {&fit.unknowns.facts.closures[c], 1}, {&zero, 1}, own).estimate);
  }
  return joints;
}

}  // namespace kinfer::identify
