// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/joints/refined_joints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinfer/identify/geometry/mean_revolute.hpp"
#include "kinfer/identify/handover/joint_ranges.hpp"
#include "kinfer/identify/refinement/fits/azimuth.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"
#include "kinfer/identify/refinement/joints/azimuth_arc.hpp"
#include "kinfer/identify/refinement/joints/joint_trajectory.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

/// Joint positions of the fit's bodies that count as 0: those at the beginning of the recording, or as the user names.
std::vector<double> zero_positions(const RefinementTask& task, const RefinementFit& fitted, const JointBodies& joint) {
  const SplineGrid& grid = fitted.setup.problem.grid;
  const InsFit& fit = fitted.fit;
  std::vector<double> positions;
  for (std::size_t b = joint.first; b <= joint.last; ++b) {
    const InsBody& body = fit.unknowns.bodies[b];
    const NamedZero* named = named_zero(task.zeros, joint, b - joint.first, segment_names(task.motion));
    const VectorXd all = spline_value(grid, fit.unknowns.spline_coefficients, named ? named->at : grid.begin);
    for (Index i = 0; i < std::max<Index>(1, degrees_of_freedom(body.motion)); ++i)
      positions.push_back(fit.layout.spline_dimension[b] < 0 ? 0.0 : all[fit.layout.spline_dimension[b] + i]);
    if (named)
      positions.back() -= (joint.first == joint.last ? axis_sense(body, joint.positive_axis) : 1.0) * named->position;
  }
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

/// A revolute joint that was relaxed to a spherical one in the fit.
RefinedJoint relaxed_joint(const RefinementFit& fitted, const JointBodies& bodies, ConstMatrixRef covariance,
                           double mount_deflection, const NamedZero* named, std::span<const double> trajectory_time) {
  const std::size_t body = bodies.first;
  const InsProblem& problem = fitted.setup.problem;
  const double misalignment =
      std::hypot(mount_deflection, 0.5 * std::max(problem.prior.gyroscope_scale, problem.prior.accelerometer_scale));
  MeanRevolute revolute =
      fit_mean_revolute(fitted.fit.unknowns.bodies[body], spherical_rotations(fitted, body, knot_times(problem.grid)),
                        covariance, misalignment);
  const double sense = axis_sense(revolute.body, bodies.positive_axis);
  if (named)
    revolute.zero += revolute_trajectory(revolute, spherical_rotations(fitted, body, {&named->at, 1}))(0, 0) -
                     sense * named->position;
  RefinedJoint joint = refined_joint(EstimatedJointType::revolute, {&revolute.body, 1}, {&revolute.zero, 1},
                                     revolute.covariance, Mat3::Identity(), bodies.positive_axis);
  joint.estimate.trajectory = sense * revolute_trajectory(revolute, spherical_rotations(fitted, body, trajectory_time));
  joint.mean = revolute;
  return joint;
}

/// One joint. `own`: its share of the covariance; `mount_deflection` [rad]: of the sensors on both sides.
RefinedJoint make_joint(const RefinementTask& task, const RefinementFit& fitted, ConstMatrixRef own,
                        double mount_deflection, const JointBodies& joint_bodies,
                        std::span<const double> trajectory_time) {
  const InsFit& fit = fitted.fit;
  const auto& [type, first, last, parent, child, positive_axis] = joint_bodies;
  const auto bodies = std::span(fit.unknowns.bodies).subspan(first, last - first + 1);
  if (joint_bodies.is_relaxed(fit.unknowns.bodies))
    return relaxed_joint(fitted, joint_bodies, own, mount_deflection,
                         named_zero(task.zeros, joint_bodies, 0, segment_names(task.motion)), trajectory_time);
  const SplineGrid& grid = fitted.setup.problem.grid;
  const MatrixXd coefficients = joint_splines(fit, joint_bodies);
  const Mat3 turning = type == EstimatedJointType::spherical
                           ? spherical_axes(spherical_rotation_vectors(grid, coefficients, trajectory_time))
                           : Mat3(Mat3::Identity());
  RefinedJoint joint =
      refined_joint(type, bodies, zero_positions(task, fitted, joint_bodies), own, turning, positive_axis);
  joint.estimate.trajectory =
      joint_trajectory(type, bodies, joint.solution.geometry, joint.zero, grid, coefficients, trajectory_time);
  return joint;
}

MatrixXd own_covariance(const InsFit& fit, ConstMatrixRef all, const JointBodies& joint) {
  const Index begin = first_unknown(fit.layout, joint), size = unknowns_of(fit.layout, fit.unknowns.bodies, joint);
  return all.block(begin, begin, size, size);
}

/// One joint with its share of the covariance of all parameters.
RefinedJoint make_joint_on_tangent(const RefinementTask& task, const RefinementFit& fitted, ConstMatrixRef all,
                                   double mount_deflection, const JointBodies& joint,
                                   std::span<const double> trajectory_time) {
  return make_joint(task, fitted, own_covariance(fitted.fit, all, joint), mount_deflection, joint, trajectory_time);
}

/// Whether the child turns about the axis of its own joint only, which keeps its direction: nothing tells where along
/// that axis the joint is.
bool turns_about_own_axis_only(const JointEstimate& joint) {
  constexpr double most_sine = 0.5;  // the direction is that of the axis, or across it
  return joint.type == EstimatedJointType::revolute && joint.unobservable_in_child.size() == 1 &&
         joint.axis_in_child.cross(joint.unobservable_in_child.front()).norm() < most_sine;
}

/// Of a joint whose axis and point lie on an arc, not on its tangent. What is unobservable stays as it is: the shifts
/// that no signal shows; and so does what the precision says of lengths, which no azimuth changes.
void widen_by_arc(const AzimuthArc& arc, RefinedJoint&& widened, RefinedJoint& joint) {
  joint.estimate.sd = widened.estimate.sd;
  if (is_point_lost(arc)) joint.estimate.sd.point_in_parent.fill(std::numeric_limits<double>::infinity());
  joint.solution.precision.canonical_sd = std::move(widened.solution.precision.canonical_sd);
}

/// One joint with its share of the covariance of all parameters, on a body that turns about its own axis only.
RefinedJoint make_joint_on_arc(const RefinementTask& task, const RefinementFit& fitted, ConstMatrixRef all,
                               double mount_deflection, const JointBodies& joint,
                               std::span<const double> trajectory_time) {
  RefinedJoint made = make_joint_on_tangent(task, fitted, all, mount_deflection, joint, trajectory_time);
  const auto arc = azimuth_arc(fitted.fit.layout, fitted.fit.unknowns.bodies, all, joint.first);
  if (!arc) return made;
  MatrixXd own = own_covariance(fitted.fit, all, joint);
  own.topLeftCorner(arc->beyond_tangent.rows(), arc->beyond_tangent.cols()) += arc->beyond_tangent;
  widen_by_arc(*arc, make_joint(task, fitted, own, mount_deflection, joint, trajectory_time), made);
  return made;
}

}  // namespace

std::vector<JointBodies> joint_bodies(const RefinementTask& task, const RefinementSetup& setup) {
  std::vector<JointBodies> all;
  for (std::size_t i = 0; i < task.starts.size(); ++i)
    all.push_back({task.starts[i].type, setup.first_body[i], setup.last_body[i], task.starts[i].parent,
                   task.starts[i].child, task.starts[i].positive_axis});
  return all;
}

MatrixXd covariance_of_parameters(const RefinementTask& task, const RefinementFit& fitted,
                                  const InsCovariance& covariance, const ModelError& error) {
  return parameter_covariance(fitted.fit, covariance, error, joint_bodies(task, fitted.setup),
                              common_axis_deviation(task, fitted));
}

std::vector<RefinedJoint> make_joints(const RefinementTask& task, const RefinementFit& fitted,
                                      const InsCovariance& covariance, const ModelError& error) {
  const std::vector<double> trajectory_time = trajectory_times(task.motion);
  const double common = common_axis_deviation(task, fitted);
  const MatrixXd all = covariance_of_parameters(task, fitted, covariance, error);
  std::vector<RefinedJoint> joints;
  for (const JointBodies& bodies : joint_bodies(task, fitted.setup)) {
    const std::string& parent = task.motion.segments[bodies.parent].name;
    const bool is_on_arc = std::ranges::any_of(joints, [&](const RefinedJoint& before) {
      return before.estimate.child == parent && turns_about_own_axis_only(before.estimate);
    });
    RefinedJoint joint = (is_on_arc ? make_joint_on_arc : make_joint_on_tangent)(
        task, fitted, all, deflection_at(bodies, error, common), bodies, trajectory_time);
    joint.estimate.parent = parent;
    joint.estimate.child = task.motion.segments[bodies.child].name;
    if (!joint.mean && turns_about_own_axis_only(joint.estimate))
      joint.estimate.azimuth_unobservable =
          azimuth_sd(fitted.fit.layout, fitted.fit.unknowns.bodies, covariance.model, bodies.last) > max_azimuth_sd;
    joints.push_back(std::move(joint));
  }
  return joints;
}

std::vector<SplineMarginal> zero_marginals(const RefinementTask& task, const RefinementFit& fitted,
                                           const InsSystem& system, const JointBodies& joint) {
  std::vector<SplineMarginal> marginals;
  for (std::size_t b = joint.first; b <= joint.last && system.is_positive_definite(); ++b) {
    const NamedZero* named = named_zero(task.zeros, joint, b - joint.first, segment_names(task.motion));
    marginals.push_back(system.spline_marginal(named ? named->at : fitted.setup.problem.grid.begin));
  }
  return marginals;
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
