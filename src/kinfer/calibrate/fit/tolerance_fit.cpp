// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/fit/tolerance_fit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "kinfer/base/overloaded.hpp"
#include "kinfer/calibrate/fit/thresholds.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/parameters/population_prior.hpp"
#include "kinfer/calibrate/start/initial_frames.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::calibrate {
namespace {

Tolerances scaled(const CalibrationTask& task, double factor) {
  Tolerances tolerances = task.tolerances;
  for (double* value : {&tolerances.angle, &tolerances.gain}) *value *= factor;
  if (lengths_are_measured(task))
    for (double* value : {&tolerances.length, &tolerances.tool_length}) *value *= factor;
  return tolerances;
}

Result<ParameterSet> select_parameter_set(const CalibrationTask& task, const PoseSet& rows,
                                          const ParameterChoice& choice, const Tolerances& tolerances) {
  return std::visit(
      Overloaded{[&](const GeometricParameters&) -> Result<ParameterSet> {
                   return geometric_parameters(task.nominal, rows, tolerances);
                 },
                 [&](const JointOffsetParameters&) -> Result<ParameterSet> {
                   return joint_offset_parameters(task.nominal, rows, tolerances);
                 },
                 [&](const PaperDhParameters&) { return paper_dh_parameters(task.nominal, tolerances); },
                 [&](const NamedParameters& named) { return named_parameters(task.nominal, tolerances, named.names); }},
      choice);
}

bool has_free_frames(const ParameterSet& set, const ParameterChoice& choice) {
  return std::holds_alternative<GeometricParameters>(choice) || std::holds_alternative<JointOffsetParameters>(choice) ||
         std::any_of(set.parameters.begin(), set.parameters.end(),
                     [](const Parameter& p) { return is_own_frame_parameter(p.at, SetupFrame::base); });
}

/// The frame of the file where the data agree with it within `frame_agreement` tolerances, else the frame estimated
/// from the data.
Frame select_prior_tool(const Frame& file, const Frame& found, double tolerance) {
  Frame tool = found;
  if ((file.xyz - found.xyz).norm() <= thresholds::frame_agreement * tolerance) tool.xyz = file.xyz;
  return tool;
}

/// The prior means: base, sockets and planes as estimated from the data; tools from the file if the data agree; anchors
/// and gravity from the file.
Chain make_prior_mean(const Chain& nominal, const Chain& found, const Tolerances& tolerances) {
  Chain centre = found;
  centre.tool = select_prior_tool(nominal.tool, found.tool, tolerances.tool_length);
  for (std::size_t m = 0; m < centre.mountings.size(); ++m)
    centre.mountings[m].tool =
        select_prior_tool(nominal.mountings[m].tool, found.mountings[m].tool, tolerances.tool_length);
  centre.fixtures.anchors = nominal.fixtures.anchors;
  centre.gravity = nominal.gravity;
  return centre;
}

/// Whether the data agree with the base of the file within `frame_agreement` tolerances.
bool base_agrees_with_data(const CalibrationTask& task, const Chain& found) {
  const Frame &file = task.nominal.base, &data = found.base;
  return (file.xyz - data.xyz).norm() <= thresholds::frame_agreement * task.tolerances.base_length &&
         angle_between(file.pose().rotation, data.pose().rotation) <=
             thresholds::frame_agreement * task.tolerances.base_angle;
}

double reach(const Chain& chain, const PoseSet& data) {
  double largest = 0.0;
  for (const Pose& pose : evaluate_poses(chain, {}, data, Derivative::no).pose)
    largest = std::max(largest, (pose.position - chain.base.xyz).norm());
  return largest;
}

Chain perturb(const Chain& start, const ParameterSet& set, Rng rng) {
  VectorXd x = pack(set, start);
  const auto free = set.free();
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (!is_joint_parameter(free[k]->at)) continue;
    if (free[k]->quantity == Quantity::length)
      x[static_cast<Eigen::Index>(k)] += thresholds::perturbation_length * rng.uniform(-1, 1);
    if (free[k]->quantity == Quantity::angle)
      x[static_cast<Eigen::Index>(k)] += thresholds::perturbation_angle * rng.uniform(-1, 1);
  }
  return unpack(set, start, x);
}

bool residuals_exceed_noise(const Estimate& estimate, const CalibrationTask& task) {
  const double instrument_sigma = task.instrument ? task.instrument->sigma : 0.0;
  return estimate.sigma > thresholds::noise_ratio * instrument_sigma;
}

}  // namespace

bool lengths_are_measured(const CalibrationTask& task) {
  bool measured = !task.nominal.fixtures.socket_distances.empty();
  for_each_list(task.data,
                [&]<class M>(const std::vector<M>& list) { measured |= M::traits.observes.scale && !list.empty(); });
  return measured;
}

Result<PreparedFit> prepare_fit(const CalibrationTask& task, const PoseSet& rows, const ParameterChoice& choice,
                                ToleranceScale scale) {
  const Tolerances tolerances = scaled(task, scale.factor);
  KINFER_TRY(set, select_parameter_set(task, rows, choice, tolerances));
  const auto with_priors = [&](const Chain& start, const ParameterSet& parameters) {
    return PreparedFit{task.earlier ? with_joint_parameters_of(start, *task.earlier, parameters) : start,
                       task.population ? with_population_prior(parameters, *task.population)
                                       : with_population_prior(parameters, task.robot_population)};
  };
  KINFER_TRY(found, with_estimated_frames(task.nominal, rows));
  if (!has_free_frames(set, choice)) return with_priors(base_agrees_with_data(task, found) ? task.nominal : found, set);
  // Wrong joint offsets disturb the tool estimated from the data: accept the earlier tool with a wider tolerance.
  Tolerances prior_tolerances = tolerances;
  if (std::holds_alternative<JointOffsetParameters>(choice))
    prior_tolerances.tool_length *= thresholds::refit_tool_factor;
  return with_priors(found, with_prior_means_at(set, make_prior_mean(task.nominal, found, prior_tolerances)));
}

Result<Chain> fit_frames_only(const CalibrationTask& task, const PoseSet& rows) {
  KINFER_TRY(start, with_estimated_frames(task.nominal, rows));
  Chain centre = start;
  centre.fixtures.anchors = task.nominal.fixtures.anchors;
  centre.gravity = task.nominal.gravity;
  const ParameterSet frames = with_prior_means_at(frame_parameters(task.nominal, rows, task.tolerances), centre);
  return fit_bundle(start, frames, rows, task.instrument).chain;
}

Result<Estimate> fit_once(const CalibrationTask& task, const PoseSet& rows, const ParameterChoice& choice,
                          ToleranceScale scale, const Observer& observer, int threads) {
  KINFER_TRY(prepared, prepare_fit(task, rows, choice, scale));
  return fit_bundle(prepared.start, prepared.parameters, rows, task.instrument, {.threads = threads}, observer);
}

Result<ScaledFit> fit_with_scaled_tolerances(const CalibrationTask& task, const PoseSet& rows,
                                             const ParameterChoice& choice, Rng rng, const Observer& observer,
                                             int threads) {
  KINFER_TRY(as_given, fit_once(task, rows, choice, {}, observer, threads));
  ScaledFit best{as_given, {}};
  if (!residuals_exceed_noise(as_given, task)) return best;
  for (const double factor : thresholds::tolerance_factors) {
    KINFER_TRY(scaled_fit, fit_once(task, rows, choice, {factor}, observer, threads));
    if (scaled_fit.negative_log_evidence < best.estimate.negative_log_evidence) best = {scaled_fit, {factor}};
  }
  const ToleranceScale widest{std::end(thresholds::tolerance_factors)[-1]};
  KINFER_TRY(prepared, prepare_fit(task, rows, choice, widest));
  const double converged_residual = thresholds::unconverged_residual * reach(prepared.start, rows);
  for (int i = 0; i < thresholds::random_starts && best.estimate.sigma > converged_residual; ++i) {
    const Chain start = perturb(prepared.start, prepared.parameters, rng.stream(i));
    const Estimate other =
        fit_bundle(start, prepared.parameters, rows, task.instrument, {.threads = threads}, observer);
    if (other.negative_log_evidence < best.estimate.negative_log_evidence) best = {other, widest};
  }
  return best;
}

}  // namespace kinfer::calibrate
