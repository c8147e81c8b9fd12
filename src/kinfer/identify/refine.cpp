#include "kinfer/identify/refine.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinfer/estimate/ins_covariance.hpp"
#include "kinfer/estimate/ins_excerpt.hpp"
#include "kinfer/estimate/ins_fact_rows.hpp"
#include "kinfer/estimate/motion_knots.hpp"
#include "kinfer/identify/azimuth.hpp"
#include "kinfer/identify/clock_fit.hpp"
#include "kinfer/identify/joint_film.hpp"
#include "kinfer/identify/loose_hinge.hpp"
#include "kinfer/identify/motion_evidence.hpp"
#include "kinfer/identify/named_facts.hpp"
#include "kinfer/identify/refine_band.hpp"
#include "kinfer/inertial/sensor_judgement.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double undetermined_azimuth = 0.1;  // [rad]
constexpr double unexplained = 3.0;           // times their own noise that instruments show where the chain is no model

/// The covariance of a joint's unknowns, those of its bodies one behind the other, as the residuals inflate it.
MatrixXd joint_covariance(const InsCovariance& covariance, const InsLayout& layout, const InsBodies& bodies,
                          std::size_t first, std::size_t last) {
  const Index begin = layout.body[first], n = layout.body[last] + bodies[last].unknowns() - begin;
  return std::max(1.0, covariance.inflation.segment(begin, n).mean()) * covariance.model.block(begin, begin, n, n);
}

/// Readings of the joint's bodies where the recording begins.
std::vector<double> first_readings(const RefineSetup& setup, const InsFit& fit, std::size_t first, std::size_t last) {
  const VectorXd all = spline_value(setup.problem.grid, fit.unknowns.band, setup.problem.grid.begin);
  std::vector<double> readings;
  for (std::size_t b = first; b <= last; ++b)
    for (Index i = 0; i < std::max<Index>(1, freedoms(fit.unknowns.bodies[b].motion)); ++i)
      readings.push_back(fit.layout.channel[b] < 0 ? 0.0 : all[fit.layout.channel[b] + i]);
  return readings;
}

/// Orientations of a ball in its parent.
std::vector<Mat3> rotations_of(const RefineFit& fitted, std::size_t body, std::span<const double> times) {
  const InsUnknowns& x = fitted.fit.unknowns;
  std::vector<Mat3> rotations;
  for (const double time : times) {
    const VectorXd all = spline_value(fitted.setup.problem.grid, x.band, time);
    rotations.push_back(exp_so3(all.segment<3>(fitted.fit.layout.channel[body])) *
                        x.bodies[body].child_R_axis.transpose());
  }
  return rotations;
}

std::vector<double> knot_times(const SplineGrid& grid) {
  std::vector<double> times;
  for (Index k = 0; k <= grid.intervals; ++k) times.push_back(grid.begin + grid.period * static_cast<double>(k));
  return times;
}

MatrixXd joined(const std::vector<MatrixXd>& parts, std::size_t first, std::size_t last) {
  MatrixXd all(0, parts[first].cols());
  for (std::size_t b = first; b <= last; ++b) {
    all.conservativeResize(all.rows() + parts[b].rows(), Eigen::NoChange);
    all.bottomRows(parts[b].rows()) = parts[b];
  }
  return all;
}

/// How much more than their own noise the instruments leave unexplained: the worst.
double misfit_of(const InsProblem& problem) {
  double worst = 1.0;
  for (const InsReadings& r : problem.sensors)
    worst = std::max({worst, r.noise.rate / r.least.rate, r.noise.force / r.least.force});
  return worst;
}

/// Spline coefficients of the joint's readings, one row a freedom.
MatrixXd joint_band(const InsFit& fit, std::size_t first, std::size_t last) {
  Index rows = 0;
  for (std::size_t b = first; b <= last; ++b) rows += freedoms(fit.unknowns.bodies[b].motion);
  return rows > 0 ? MatrixXd(fit.unknowns.band.middleRows(fit.layout.channel[first], rows)) : MatrixXd();
}

std::vector<FoundPlace> found_places(const MachineFacts& facts, const InsFit& fit, ConstMatrixRef covariance) {
  std::vector<FoundPlace> places;
  for (std::size_t i = 0; i < facts.places.size(); ++i) {
    const Index at = fit.layout.facts + 3 * static_cast<Index>(i);
    places.push_back({facts.places[i].name, facts.places[i].sensor, fit.unknowns.facts.places[i],
                      covariance.diagonal().segment<3>(at).cwiseSqrt()});
  }
  return places;
}

RefineFit fit_all_motion(const RefineTask& task, RefineSetup setup, const RefineOptions& options,
                         const Observer& observer) {
  RefineFit fitted{std::move(setup), {}};
  InsProblem& problem = fitted.setup.problem;
  problem.facts = task.facts;
  fitted.setup.start.facts = started_facts(problem, layout_of(problem, fitted.setup.start.bodies), fitted.setup.start);
  start_from_excerpt(problem, fitted.setup.start, task.options, observer);
  if (options.clocks == Clocks::estimated) free_clocks(problem);
  fitted.fit = fit_ins(problem, fitted.setup.start, task.options, observer);
  if (options.clocks == Clocks::checked && clocks_are_doubtful(problem, fitted.fit, task.options.threads))
    refit_with_clocks(problem, fitted.fit, task.options, observer);
  return fitted;
}

/// A sensor's clock is still to be put right, by the caller.
bool clocks_differ(const InsUnknowns& x) {
  constexpr double notable = 1e-3;  // [s]
  return std::ranges::any_of(x.errors, [](const InsErrors& e) { return std::abs(e.clock.offset) > notable; });
}

/// [rad] How far the least straying hinge strays. What even that one shows is the mounts': INS that give way in step
/// with the motion, so that it does not average out. 0 where a hinge held strictly: then the mounts do, too.
double softness_of(const RefineTask& task, const RefineFit& fitted) {
  double least = 0.0;
  for (std::size_t i = 0; i < task.starts.size(); ++i) {
    if (task.starts[i].type != FoundJointType::revolute) continue;
    const std::size_t body = fitted.setup.first_body[i];
    const InsBody& ball = fitted.fit.unknowns.bodies[body];
    if (ball.motion != JointMotion::ball) return 0.0;
    const auto rotations = rotations_of(fitted, body, knot_times(fitted.setup.problem.grid));
    const double stray = loose_hinge(ball, rotations, MatrixXd::Zero(6, 6), 0.0).stray;
    least = least > 0.0 ? std::min(least, stray) : stray;
  }
  return least;
}

/// Points of a ball in frames that lean by so much on their segments: 6 x 6.
void lean(MatrixXd& covariance, const InsBody& ball, double angle) {
  covariance.diagonal().head<3>().array() += angle * angle * ball.point_in_parent.squaredNorm();
  covariance.diagonal().tail<3>().array() += angle * angle * ball.point_in_child.squaredNorm();
}

/// Axes in frames that lean by so much on their segments.
void lean_axes(MatrixXd& covariance, const InsBody& body, double parent, double child) {
  if (body.motion != JointMotion::turn && body.motion != JointMotion::slide) return;
  covariance.diagonal().head<2>().array() += parent * parent;
  covariance.diagonal().segment<2>(2).array() += child * child;
}

/// A hinge that was let loose in the fit.
RefinedJoint joint_of_ball(const RefineFit& fitted, std::size_t body, ConstMatrixRef covariance, double softness,
                           std::span<const double> film_time) {
  const InsProblem& problem = fitted.setup.problem;
  const double crossed = std::hypot(softness, 0.5 * std::max(problem.prior.rate_matrix, problem.prior.force_matrix));
  const LooseHinge hinge = loose_hinge(fitted.fit.unknowns.bodies[body],
                                       rotations_of(fitted, body, knot_times(problem.grid)), covariance, crossed);
  RefinedJoint joint = refined_joint(FoundJointType::revolute, {&hinge.body, 1}, {&hinge.zero, 1}, hinge.covariance);
  joint.stray = hinge.stray;
  joint.found.film = loose_film(hinge, rotations_of(fitted, body, film_time));
  if (joint.hinge.geometry.axis_in_parent.dot(hinge.body.parent_R_axis.col(2)) < 0.0) joint.found.film *= -1.0;
  return joint;
}

/// One joint with its share of the covariance and of the model's error.
RefinedJoint joint_of(const RefineTask& task, const RefineFit& fitted, const InsCovariance& covariance,
                      const ModelError& error, double softness, std::size_t index, std::span<const double> film_time) {
  const JointStart& start = task.starts[index];
  const InsFit& fit = fitted.fit;
  const std::size_t first = fitted.setup.first_body[index], last = fitted.setup.last_body[index];
  const auto bodies = std::span(fit.unknowns.bodies).subspan(first, last - first + 1);
  MatrixXd own = joint_covariance(covariance, fit.layout, fit.unknowns.bodies, first, last);
  if (!error.shift.empty()) {
    const MatrixXd moved = joined(error.shift, first, last);
    own += moved * moved.transpose();
    softness = std::hypot(softness, error.lean[start.parent], error.lean[start.child]);
    lean_axes(own, bodies.front(), error.lean[start.parent], error.lean[start.child]);
  }
  if (bodies.front().motion == JointMotion::ball) lean(own, bodies.front(), softness);
  if (start.type == FoundJointType::revolute && bodies.front().motion == JointMotion::ball)
    return joint_of_ball(fitted, first, own, softness, film_time);
  const SplineGrid& grid = fitted.setup.problem.grid;
  const MatrixXd band = joint_band(fit, first, last);
  const bool is_ball = start.type == FoundJointType::spherical;
  const Mat3 turning = is_ball ? ball_axes(ball_turns(grid, band, film_time)) : Mat3(Mat3::Identity());
  RefinedJoint joint = refined_joint(start.type, bodies, first_readings(fitted.setup, fit, first, last), own, turning);
  joint.found.film = joint_film(start.type, bodies, joint.hinge.geometry, grid, band, film_time);
  if (start.type == FoundJointType::revolute && joint.found.not_identifiable_in_child.size() == 1)
    joint.found.azimuth_undetermined =
        azimuth_sd(fit.layout, fit.unknowns.bodies, covariance.model, last) > undetermined_azimuth;
  return joint;
}

/// All joints, named.
std::vector<RefinedJoint> joints_of(const RefineTask& task, const RefineFit& fitted, const InsCovariance& covariance,
                                    const ModelError& error) {
  const std::vector<double> film_time = film_times(task.motion);
  const double softness = softness_of(task, fitted);
  std::vector<RefinedJoint> joints;
  for (std::size_t i = 0; i < task.starts.size(); ++i) {
    joints.push_back(joint_of(task, fitted, covariance, error, softness, i, film_time));
    joints.back().found.parent = task.motion.segments[task.starts[i].parent].name;
    joints.back().found.child = task.motion.segments[task.starts[i].child].name;
  }
  return joints;
}

/// `fitted` has the fit without the windows afterwards.
HeldOut held_out(const RefineTask& task, RefineFit& fitted, const InsCovariance& covariance, const ModelError& error) {
  const SplineGrid& grid = fitted.setup.problem.grid;
  const auto intervals = held_out_intervals(grid);
  HeldOut held;
  for (const auto& [begin, end] : intervals)
    held.windows.push_back(
        {grid.begin + grid.period * static_cast<double>(begin), grid.begin + grid.period * static_cast<double>(end)});
  fitted.fit = fit_without(fitted.setup.problem, fitted.fit.unknowns, intervals, task.options);
  for (const RefinedJoint& joint : joints_of(task, fitted, covariance, error)) held.joints.push_back(joint.found);
  return held;
}

}  // namespace

Result<Refinement> refine(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                          const std::vector<JointStart>& starts, const RefineOptions& options,
                          const Observer& observer) {
  const SensorModel grade = options.grade ? *options.grade : judged_model(recording);
  const double knots = options.knots > 0.0 ? options.knots : motion_knots(recording);
  RefineSetup setup = refine_setup(recording, motion, tree, starts, grade, knots);
  KINFER_TRY(facts, named_facts(options.facts, segment_names(motion), setup.start.bodies, setup.problem.grid,
                                setup.problem.root_stands_still));
  const RefineTask task{recording, motion, tree, starts, grade, facts, options.fit};
  RefineFit fitted = fit_all_motion(task, std::move(setup), options, observer);
  Refinement result;
  result.grade = grade.name;
  result.knots = knots;
  for (const InsReadings& readings : fitted.setup.problem.sensors) {
    result.noise.push_back(readings.noise);
    result.least.push_back(readings.least);
  }
  ModelError model_error;
  if (misfit_of(fitted.setup.problem) > unexplained && !clocks_differ(fitted.fit.unknowns)) {
    SlowMotion slow = fit_slow_motion(task, fitted, observer);
    fitted = std::move(slow.fitted);
    model_error = std::move(slow.error);
    result.noise = std::move(slow.noise);
    result.cutoff = slow.cutoff;
  }
  result.fit = fitted.fit;
  fitted.fit.cost = {};  // an hour's residuals are large
  const auto covariance =
      covariance_of(fitted.setup.problem, result.fit.layout, result.fit.unknowns, options.fit.threads);
  if (!covariance) return error("the continuous-time fit has no covariance: the recording says too little");
  result.covariance = covariance->model;
  result.clocks = refined_clocks(fitted.setup.problem, result.fit, *covariance);
  result.joints = joints_of(task, fitted, *covariance, model_error);
  if (options.hold_out) result.held_out = held_out(task, fitted, *covariance, model_error);
  result.places = found_places(options.facts, result.fit, covariance->model);
  return result;
}

}  // namespace kinfer
