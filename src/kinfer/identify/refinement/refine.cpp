// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/refine.hpp"
#include "kinfer/estimate/continuous/fit_comparison.hpp"
#include "kinfer/identify/handover/tracking_model.hpp"
#include "kinfer/identify/loops/loop_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinfer/estimate/continuous/excerpt.hpp"
#include "kinfer/estimate/continuous/fast_motion.hpp"
#include "kinfer/estimate/continuous/knot_spacing.hpp"
#include "kinfer/estimate/continuous/solver/fact_residuals.hpp"
#include "kinfer/estimate/continuous/solver/model_error.hpp"
#include "kinfer/estimate/continuous/solver/noise_update.hpp"
#include "kinfer/identify/refinement/fact_resolution.hpp"
#include "kinfer/identify/refinement/fits/azimuth.hpp"
#include "kinfer/identify/refinement/fits/clock_fit.hpp"
#include "kinfer/identify/refinement/fits/low_frequency_fit.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"
#include "kinfer/identify/refinement/joints/refined_joints.hpp"
#include "kinfer/identify/refinement/scales/instrument_scales.hpp"
#include "kinfer/identify/refinement/scales/scale_findings.hpp"
#include "kinfer/identify/refinement/wrong_facts.hpp"
#include "kinfer/inertial/rest/rest.hpp"
#include "kinfer/inertial/sensor_grading.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

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
  if (options.clocks == ClockTreatment::estimated) free_clocks(problem, fitted.setup.start.bodies);
  fitted.fit = fit_ins(problem, fitted.setup.start, task.options, observer);
  search_azimuths(task, fitted, observer);
  if (options.clocks == ClockTreatment::checked && clocks_are_doubtful(problem, fitted.fit, task.options.threads))
    refit_with_free_clocks(problem, fitted.fit, task.options, observer);
  return fitted;
}

/// A grade that is neither given nor seen in rests is a guess: scale errors of its size stay possible beside those that
/// the fit estimates.
AssumedScale assumed_scale(const InsRecording& recording, const RefinementOptions& options, const SensorModel& grade) {
  const bool is_guess = !options.grade && std::ranges::any_of(recording.sensors, [&](const InsSensor& sensor) {
    return rest_periods(sensor, recording.time(sensor)).empty();
  });
  return is_guess ? AssumedScale{grade.gyroscope.scale_sd, grade.accelerometer.scale_sd} : AssumedScale{};
}

/// What deviates from its stated accuracy.
struct Deviations {
  ScaleReview scales;
  std::vector<Finding> wrong_facts;
};

/// A wrong fact may pass for scale errors or for noise, or lead the fit astray: without it all begins anew, so that
/// nothing of it is left. The other way round, the scales come first: a sound tape contradicts a recording whose clock
/// runs fast.
template <class SetUp>
Deviations find_deviations(InsFacts& facts, const RefinementTask& task, const SetUp& set_up, RefinementFit& fitted,
                           const RefinementOptions& options, const Observer& observer) {
  Deviations found;
  found.scales = refit_deviant_scales(task, fitted, observer);
  found.wrong_facts = leave_out_wrong_facts(facts, task, fitted);
  if (std::ranges::none_of(found.wrong_facts, &Finding::applied)) return found;
  fitted = fit_full_bandwidth(task, set_up(), options, observer);
  found.scales = refit_deviant_scales(task, fitted, observer);
  return found;
}

/// To the fit in which motion that the splines do not follow counts as any other. Both know the measured azimuths.
std::vector<MatrixXd> shifts_with_fast_motion(const RefinementTask& task, const RefinementFit& fitted) {
  const RefinementFit all = refit_with(task, fitted, [](RefinementSetup& setup) { count_fast_motion(setup.problem); });
  return shifts(fitted.fit.unknowns.bodies, all.fit.unknowns.bodies);
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

/// Where a sliding joint's positions count from and the point in its parent are two names of one unknown. Tracking
/// takes the positions from a stated zero: there the point is as certain as the length of a boom is.
InsCovariance with_slides_anchored(RefinementFit& fitted, const InsFit& fit, const InsCovariance& covariance,
                                   const AssumedScale& assumed, int threads) {
  constexpr double held = 1e-6, weak = 3.0;  // [m], [rad]
  InsProblem& problem = fitted.setup.problem;
  const Index first = problem.root_at_rest ? 0 : 6;
  std::vector<double> anchor_sd(static_cast<std::size_t>(fit.layout.spline_dimensions - first), weak);
  bool has_slides = false;
  for (std::size_t b = 0; b < fit.unknowns.bodies.size(); ++b)
    if (fit.unknowns.bodies[b].motion == JointMotion::prismatic) {
      anchor_sd[static_cast<std::size_t>(fit.layout.spline_dimension[b] - first)] = held;
      has_slides = true;
    }
  if (!has_slides) return covariance;
  problem.anchor_sd = std::move(anchor_sd);
  const auto anchored = covariance_with_model_error(problem, fit.layout, fit.unknowns, fit.cost, assumed, threads);
  problem.anchor_sd.clear();
  return anchored.value_or(covariance);
}

TrackingModel hand_over(const RefinementTask& task, const RefinementFit& fitted, const Refinement& result,
                        const InsCovariance& covariance, const ModelError& error) {
  std::vector<FittedJoint> joints;
  const std::vector<JointBodies> bodies = joint_bodies(task, fitted.setup);
  const InsSystem system(fitted.setup.problem, result.fit.layout, result.fit.unknowns, {}, task.options.threads);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const RefinedJoint& joint = result.joints[i];
    joints.push_back({joint.estimate, joint.solution.geometry, bodies[i], joint.zero,
                      zero_marginals(task, fitted, system, bodies[i]), joint.mean});
  }
  const MatrixXd all = covariance_of_parameters(task, fitted, covariance, error);
  return tracking_model({task.recording, fitted.setup.problem, result.fit, result.noise, result.noise_floor, error, all,
                         std::move(joints)});
}

/// Without a covariance where the arithmetic does not hold the equations.
struct RefinementAttempt {
  std::optional<Refinement> refinement{};
  bool is_noise_raised = false;
};

Result<RefinementAttempt> refine_with(const InsRecording& recording, const RecordedMotion& motion,
                                      const SegmentTree& tree, const std::vector<InitialJoint>& starts,
                                      const RefinementOptions& options, const SensorModel& grade, double knot_spacing,
                                      double least_noise, const Observer& observer) {
  const auto set_up = [&] {
    RefinementSetup made =
        set_up_refinement(recording, motion, tree, starts, grade, knot_spacing, least_noise, options.common);
    if (!options.common.gyroscope.is_none()) return made;  // by a clock that runs fast all motion is
    for (std::size_t s = 0; s < recording.sensors.size(); ++s)
      discount_fast_motion(made.problem.sensors[s], recording.sensors[s], recording.time(recording.sensors[s]),
                           made.problem.grid);
    return made;
  };
  RefinementSetup setup = set_up();
  const bool is_noise_raised = setup.is_noise_raised;
  KINFER_TRY(facts, resolve_facts(options.facts, segment_names(motion), setup.start.bodies, setup.problem.grid,
                                  setup.problem.root_at_rest));
  const RefinementTask task{recording, motion,      tree,          starts,      grade,
                            facts,     options.fit, options.zeros, least_noise, options.common};
  if (const auto checked =
          check_zeros(options.zeros, joint_bodies(task, setup), segment_names(motion), setup.problem.grid);
      !checked)
    return forward_error(checked.error());
  Refinement result;
  RefinementFit fitted = fit_full_bandwidth(task, std::move(setup), options, observer);
  const Deviations deviations = find_deviations(facts, task, set_up, fitted, options, observer);
  result.negative_log_likelihood = negative_log_likelihood(fitted.setup.problem, fitted.fit.cost);
  std::vector<FoundLoop> loops;
  if (options.loops == LoopTreatment::closed) loops = close_loops(fitted.setup.problem, fitted.fit, options.fit);
  facts.closures = fitted.setup.problem.facts.closures;
  result.grade = grade.name;
  result.knot_spacing = knot_spacing;
  result.noise = recorded_noise(fitted.setup.problem, fitted.fit.cost);
  for (const InsMeasurements& sensor : fitted.setup.problem.sensors) result.noise_floor.push_back(sensor.noise_floor);
  ModelError model_error;
  if (worst_misfit(fitted.setup.problem) > max_rigid_chain_misfit &&
      !clocks_differ(fitted.setup.problem.grid, fitted.fit.unknowns)) {
    LowFrequencyFit slow = fit_low_frequency(task, fitted, observer);
    fitted = std::move(slow.fitted);
    model_error = std::move(slow.error);
    result.noise = std::move(slow.noise);
    result.noise_floor = std::move(slow.noise_floor);
    result.cutoff = slow.cutoff;
  }
  measure_azimuths(task, fitted);
  if (result.cutoff <= 0.0 && discounts_fast_motion(fitted.setup.problem))
    model_error = {shifts_with_fast_motion(task, fitted), std::vector<double>(recording.sensors.size())};
  result.fit = fitted.fit;
  fitted.fit.cost = {};  // frees memory: the residuals of an hour are large
  const auto covariance =
      covariance_with_model_error(fitted.setup.problem, result.fit.layout, result.fit.unknowns, result.fit.cost,
                                  assumed_scale(recording, options, grade), options.fit.threads);
  if (!covariance) return RefinementAttempt{std::nullopt, is_noise_raised};
  result.covariance = covariance->model;
  add_clock_rate(deviations.scales, options.common, result.fit, *covariance, model_error);
  result.findings = scale_findings(deviations.scales, motion, options.common, result.fit, *covariance);
  result.findings.insert(result.findings.begin(), deviations.wrong_facts.begin(), deviations.wrong_facts.end());
  result.clocks = refined_clocks(fitted.setup.problem, result.fit, *covariance);
  result.joints = make_joints(task, fitted, *covariance, model_error);
  result.tracking = hand_over(task, fitted, result,
                              with_slides_anchored(fitted, result.fit, *covariance,
                                                   assumed_scale(recording, options, grade), options.fit.threads),
                              model_error);
  result.loops =
      loop_estimates(loops, fitted.fit.unknowns.bodies, closing_joints(fitted.fit, *covariance), segment_names(motion));
  if (options.hold_out) result.held_out = fit_held_out(task, fitted, *covariance, model_error);
  result.places = located_points(options.facts, result.fit, covariance->model);
  return RefinementAttempt{std::move(result), is_noise_raised};
}

}  // namespace

Result<Refinement> refine(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                          const std::vector<InitialJoint>& starts, const RefinementOptions& options,
                          const Observer& observer) {
  const SensorModel grade = options.grade ? *options.grade : estimate_sensor_model(recording);
  const double knot_spacing = options.knot_spacing > 0.0 ? options.knot_spacing : select_knot_spacing(recording, grade);
  for (const double least_noise : least_noises) {
    KINFER_TRY(attempt,
               refine_with(recording, motion, tree, starts, options, grade, knot_spacing, least_noise, observer));
    if (attempt.refinement) return *std::move(attempt.refinement);
    if (!attempt.is_noise_raised) break;
  }
  return error("the continuous-time fit has no covariance: the recording is not informative enough");
}

}  // namespace kinfer::identify
