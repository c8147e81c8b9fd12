// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/refine.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinfer/estimate/continuous/excerpt.hpp"
#include "kinfer/estimate/continuous/knot_spacing.hpp"
#include "kinfer/estimate/continuous/solver/covariance.hpp"
#include "kinfer/estimate/continuous/solver/fact_residuals.hpp"
#include "kinfer/identify/findings/motion_evidence.hpp"
#include "kinfer/identify/geometry/mean_revolute.hpp"
#include "kinfer/identify/refinement/azimuth.hpp"
#include "kinfer/identify/refinement/clock_fit.hpp"
#include "kinfer/identify/refinement/fact_resolution.hpp"
#include "kinfer/identify/refinement/joint_trajectory.hpp"
#include "kinfer/identify/refinement/low_frequency_fit.hpp"
#include "kinfer/inertial/sensor_grading.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

constexpr double max_azimuth_sd = 0.1;  // [rad] sd of an azimuth that counts as undetermined
constexpr double max_misfit = 3.0;      // residual noise over noise floor above which a rigid chain is not valid

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
  std::vector<double> readings;
  for (std::size_t b = first; b <= last; ++b)
    for (Index i = 0; i < std::max<Index>(1, degrees_of_freedom(fit.unknowns.bodies[b].motion)); ++i)
      readings.push_back(fit.layout.spline_dimension[b] < 0 ? 0.0 : all[fit.layout.spline_dimension[b] + i]);
  return readings;
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

/// Largest ratio of residual noise to noise floor over all instruments.
double worst_misfit(const InsProblem& problem) {
  double worst = 1.0;
  for (const InsMeasurements& r : problem.sensors)
    worst = std::max(
        {worst, r.noise.angular_velocity / r.noise_floor.angular_velocity, r.noise.force / r.noise_floor.force});
  return worst;
}

/// Spline coefficients of the joint positions, one row a degree of freedom.
MatrixXd joint_spline_coefficients(const InsFit& fit, std::size_t first, std::size_t last) {
  Index rows = 0;
  for (std::size_t b = first; b <= last; ++b) rows += degrees_of_freedom(fit.unknowns.bodies[b].motion);
  return rows > 0 ? MatrixXd(fit.unknowns.spline_coefficients.middleRows(fit.layout.spline_dimension[first], rows))
                  : MatrixXd();
}

std::vector<PointEstimate> located_points(const MachineMeasurements& facts, const InsFit& fit,
                                          ConstMatrixRef covariance) {
  std::vector<PointEstimate> places;
  for (std::size_t i = 0; i < facts.places.size(); ++i) {
    const Index at = fit.layout.facts + 3 * static_cast<Index>(i);
    places.push_back({facts.places[i].name, facts.places[i].sensor, fit.unknowns.facts.places[i],
                      covariance.diagonal().segment<3>(at).cwiseSqrt()});
  }
  return places;
}

RefinementFit fit_full_bandwidth(const RefinementTask& task, RefinementSetup setup, const RefinementOptions& options,
                                 const Observer& observer) {
  RefinementFit fitted{std::move(setup), {}};
  InsProblem& problem = fitted.setup.problem;
  problem.facts = task.facts;
  fitted.setup.start.facts =
      initial_fact_unknowns(problem, layout_of(problem, fitted.setup.start.bodies), fitted.setup.start);
  start_from_excerpt(problem, fitted.setup.start, task.options, observer);
  if (options.clocks == ClockTreatment::estimated) free_clocks(problem);
  fitted.fit = fit_ins(problem, fitted.setup.start, task.options, observer);
  if (options.clocks == ClockTreatment::checked && clocks_are_doubtful(problem, fitted.fit, task.options.threads))
    refit_with_free_clocks(problem, fitted.fit, task.options, observer);
  return fitted;
}

/// Whether a clock is wrong by so much that the caller will correct it and fit again.
bool clocks_differ(const InsUnknowns& x) {
  constexpr double max_offset = 1e-3;  // [s] of a clock offset
  return std::ranges::any_of(x.errors, [](const InsErrors& e) { return std::abs(e.clock.offset) > max_offset; });
}

/// [rad] Smallest axis deviation of the relaxed revolute joints. What even that joint shows is attributed to compliant
/// mounts, which deflect in phase with the motion, so that it does not average out. 0 where a revolute joint was not
/// relaxed: then the mounts are rigid, too.
double common_axis_deviation(const RefinementTask& task, const RefinementFit& fitted) {
  double smallest = 0.0;
  for (std::size_t i = 0; i < task.starts.size(); ++i) {
    if (task.starts[i].type != EstimatedJointType::revolute) continue;
    const std::size_t body = fitted.setup.first_body[i];
    const InsBody& ball = fitted.fit.unknowns.bodies[body];
    if (ball.motion != JointMotion::spherical) return 0.0;
    const auto rotations = spherical_rotations(fitted, body, knot_times(fitted.setup.problem.grid));
    const double axis_deviation = fit_mean_revolute(ball, rotations, MatrixXd::Zero(6, 6), 0.0).axis_deviation;
    smallest = smallest > 0.0 ? std::min(smallest, axis_deviation) : axis_deviation;
  }
  return smallest;
}

/// Adds to a spherical joint's points (6 x 6) that the sensor frames deflect by `angle` [rad] on their segments.
void add_point_deflection(MatrixXd& covariance, const InsBody& ball, double angle) {
  covariance.diagonal().head<3>().array() += angle * angle * ball.point_in_parent.squaredNorm();
  covariance.diagonal().tail<3>().array() += angle * angle * ball.point_in_child.squaredNorm();
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
  const MeanRevolute hinge =
      fit_mean_revolute(fitted.fit.unknowns.bodies[body], spherical_rotations(fitted, body, knot_times(problem.grid)),
                        covariance, misalignment);
  RefinedJoint joint =
      refined_joint(EstimatedJointType::revolute, {&hinge.body, 1}, {&hinge.zero, 1}, hinge.covariance);
  joint.axis_deviation = hinge.axis_deviation;
  joint.estimate.trajectory = revolute_trajectory(hinge, spherical_rotations(fitted, body, trajectory_time));
  if (joint.solution.geometry.axis_in_parent.dot(hinge.body.parent_R_axis.col(2)) < 0.0)
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
    own += moved * moved.transpose();
    mount_deflection =
        std::hypot(mount_deflection, error.mount_deflection[start.parent], error.mount_deflection[start.child]);
    add_axis_deflection(own, bodies.front(), error.mount_deflection[start.parent], error.mount_deflection[start.child]);
  }
  if (bodies.front().motion == JointMotion::spherical) add_point_deflection(own, bodies.front(), mount_deflection);
  if (start.type == EstimatedJointType::revolute && bodies.front().motion == JointMotion::spherical)
    return relaxed_joint(fitted, first, own, mount_deflection, trajectory_time);
  const SplineGrid& grid = fitted.setup.problem.grid;
  const MatrixXd band = joint_spline_coefficients(fit, first, last);
  const bool is_spherical = start.type == EstimatedJointType::spherical;
  const Mat3 turning =
      is_spherical ? spherical_axes(spherical_rotation_vectors(grid, band, trajectory_time)) : Mat3(Mat3::Identity());
  RefinedJoint joint =
      refined_joint(start.type, bodies, initial_joint_positions(fitted.setup, fit, first, last), own, turning);
  joint.estimate.trajectory =
      joint_trajectory(start.type, bodies, joint.solution.geometry, grid, band, trajectory_time);
  if (start.type == EstimatedJointType::revolute && joint.estimate.unobservable_in_child.size() == 1)
    joint.estimate.azimuth_unobservable =
        azimuth_sd(fit.layout, fit.unknowns.bodies, covariance.model, last) > max_azimuth_sd;
  return joint;
}

/// All joints, with the names of their segments.
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

/// Fits again without some windows; `fitted` then holds that fit.
HeldOut fit_held_out(const RefinementTask& task, RefinementFit& fitted, const InsCovariance& covariance,
                     const ModelError& error) {
  const SplineGrid& grid = fitted.setup.problem.grid;
  const auto intervals = held_out_intervals(grid);
  HeldOut held;
  for (const auto& [begin, end] : intervals)
    held.windows.push_back(
        {grid.begin + grid.period * static_cast<double>(begin), grid.begin + grid.period * static_cast<double>(end)});
  fitted.fit = fit_without_intervals(fitted.setup.problem, fitted.fit.unknowns, intervals, task.options);
  for (const RefinedJoint& joint : make_joints(task, fitted, covariance, error)) held.joints.push_back(joint.estimate);
  return held;
}

}  // namespace

Result<Refinement> refine(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                          const std::vector<InitialJoint>& starts, const RefinementOptions& options,
                          const Observer& observer) {
  const SensorModel grade = options.grade ? *options.grade : estimate_sensor_model(recording);
  const double knot_spacing = options.knot_spacing > 0.0 ? options.knot_spacing : select_knot_spacing(recording);
  RefinementSetup setup = set_up_refinement(recording, motion, tree, starts, grade, knot_spacing);
  KINFER_TRY(facts, resolve_facts(options.facts, segment_names(motion), setup.start.bodies, setup.problem.grid,
                                  setup.problem.root_at_rest));
  const RefinementTask task{recording, motion, tree, starts, grade, facts, options.fit};
  RefinementFit fitted = fit_full_bandwidth(task, std::move(setup), options, observer);
  Refinement result;
  result.grade = grade.name;
  result.knot_spacing = knot_spacing;
  for (const InsMeasurements& readings : fitted.setup.problem.sensors) {
    result.noise.push_back(readings.noise);
    result.noise_floor.push_back(readings.noise_floor);
  }
  ModelError model_error;
  if (worst_misfit(fitted.setup.problem) > max_misfit && !clocks_differ(fitted.fit.unknowns)) {
    LowFrequencyFit slow = fit_low_frequency(task, fitted, observer);
    fitted = std::move(slow.fitted);
    model_error = std::move(slow.error);
    result.noise = std::move(slow.noise);
    result.cutoff = slow.cutoff;
  }
  result.fit = fitted.fit;
  fitted.fit.cost = {};  // frees memory: the residuals of an hour are large
  const auto covariance =
      covariance_of(fitted.setup.problem, result.fit.layout, result.fit.unknowns, options.fit.threads);
  if (!covariance) return error("the continuous-time fit has no covariance: the recording is not informative enough");
  result.covariance = covariance->model;
  result.clocks = refined_clocks(fitted.setup.problem, result.fit, *covariance);
  result.joints = make_joints(task, fitted, *covariance, model_error);
  if (options.hold_out) result.held_out = fit_held_out(task, fitted, *covariance, model_error);
  result.places = located_points(options.facts, result.fit, covariance->model);
  return result;
}

}  // namespace kinfer::identify
