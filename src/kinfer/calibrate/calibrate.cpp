// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kinfer/base/largest_length.hpp"
#include "kinfer/calibrate/conclusion/least_motion.hpp"
#include "kinfer/calibrate/conclusion/notes.hpp"
#include "kinfer/calibrate/conclusion/plot_data.hpp"
#include "kinfer/calibrate/conclusion/recommendations.hpp"
#include "kinfer/calibrate/conclusion/unobserved_lengths.hpp"
#include "kinfer/calibrate/conclusion/verdict.hpp"
#include "kinfer/calibrate/diagnosis/diagnose.hpp"
#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"
#include "kinfer/calibrate/diagnosis/fit_residuals.hpp"
#include "kinfer/calibrate/diagnosis/moving_points.hpp"
#include "kinfer/calibrate/fit/population_choice.hpp"
#include "kinfer/calibrate/prediction/model_error.hpp"
#include "kinfer/calibrate/prediction/unobserved_tool.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/calibrate/starting_model.hpp"
#include "kinfer/calibrate/validated_fit.hpp"
#include "kinfer/calibrate/validation/iso9283.hpp"
#include "kinfer/calibrate/validation/kind_errors.hpp"
#include "kinfer/estimate/poses/repeated_measurements.hpp"
#include "kinfer/measurement/copies.hpp"

namespace kinfer::calibrate {
namespace {

/// Expresses base and tool relative to the frames of the file; the fit itself is relative to the frames from the data.
void express_frames_relative_to_file(std::vector<ParameterEstimate>& values, const ParameterSet& set, const Chain& file,
                                     const Chain& calibrated) {
  const auto coordinate = [](const Frame& from, const Frame& to, Field field) {
    const auto k = static_cast<int>(field);
    if (is_translation(field)) return std::pair{from.xyz[k], to.xyz[k]};
    const Vec3 turn = to_intrinsic_xyz(from.pose().rotation.transpose() * to.pose().rotation);
    return std::pair{0.0, turn[k - static_cast<int>(Field::rx)]};
  };
  const std::vector<const Parameter*> free = set.free();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto* at = std::get_if<FrameNumber>(&free[i]->at);
    if (!at || at->mounting >= 0) continue;
    const bool base = at->frame == SetupFrame::base;
    std::tie(values[i].nominal, values[i].value) =
        coordinate(base ? file.base : file.tool, base ? calibrated.base : calibrated.tool, at->field);
  }
}

/// Lists held-out rows with gross errors among the outliers.
void list_gross_errors(Estimate& estimate, const std::vector<Outlier>& gross_errors, const ExcludedRows& excluded,
                       const ValidationPlan& plan) {
  std::vector<Outlier> held_out;
  for (Outlier outlier : gross_errors) {
    if (std::ranges::find(excluded.rows, outlier.row) == excluded.rows.end()) continue;
    outlier.held_out = std::ranges::find(plan.fitted, outlier.row) == plan.fitted.end();
    held_out.push_back(outlier);
  }
  merge_outliers(estimate.outliers, held_out);
}

/// An error where a number of the fit is none that a chain can have: it would be written and could not be read again.
Result<void> expect_possible_numbers(const Estimate& estimate) {
  for (const ParameterEstimate& value : estimate.values)
    if (value.quantity == Quantity::length && !(std::abs(value.value) <= largest_length))
      return error(
          "{} at {:.3g} m is the best that the fit finds: no place explains these measurements, so they do not belong "
          "to these joint positions",
          value.name, value.value);
  return {};
}

Diagnosis diagnose_mountings(const CalibrationTask& task) {
  const bool one_mounting = task.data.setups.size() < 2 && task.data.tips.empty();
  return one_mounting ? diagnose(task) : diagnose_joint_positions(task);
}

/// Of the measurements whose errors are judged.
bool noise_is_stated(const CalibrationTask& task) {
  const auto primary = primary_measurement_kind(task.data);
  return task.instrument && (!primary || task.instrument->states_lengths() ||
                             residual_kind(*primary).traits.sigma_of(*task.instrument) > 0.0);
}

/// With all certain faults corrected, and the fixtures and directions of approach of the data.
Result<CalibrationTask> prepare_task(const Diagnosis& diagnosis) {
  CalibrationTask task = diagnosis.corrected_task;
  KINFER_TRY(placed, with_fixtures(task.nominal, task.data));
  task.nominal = placed.chain;
  task.data = with_approach(with_commanded_poses(without_copies(placed.data), task.nominal));
  return task;
}

}  // namespace

Result<Calibration> calibrate_robot(const CalibrationTask& given, const CalibrationOptions& options, Rng rng,
                                    const Observer& observer) {
  if (auto consistent = check_options(given, options); !consistent) return forward_error(consistent.error());
  KINFER_TRY(start, make_starting_model(given, options, rng));
  const Diagnosis diagnosis = diagnose_mountings(start.task);
  KINFER_TRY(prepared, prepare_task(diagnosis));
  if (auto moving = expect_moving_points(prepared); !moving) return forward_error(moving.error());
  KINFER_TRY(plan, make_validation_plan(prepared.data, options, rng.stream(1)));
  const PoseSet fitted = select(prepared.data, plan.fitted);
  KINFER_TRY(population, choose_population(prepared, fitted, options.parameters, rng.stream(2)));
  const CalibrationTask& task = population.task;
  KINFER_TRY(frames_only, fit_frames_only(task, fitted));
  KINFER_TRY(fit, fit_and_validate(task, plan, fitted, options, rng, observer));
  if (auto possible = expect_possible_numbers(fit.estimate); !possible) return forward_error(possible.error());
  const ExcludedRows excluded = select_excluded_rows(fit.gross_errors, plan);

  Calibration calibration;
  calibration.nominal_model = {start.task.nominal, start.task.tolerances};
  calibration.unknown_robot = start.unknown_robot;
  calibration.estimate = fit.estimate;
  calibration.estimate.outliers = with_data_rows(fit.estimate.outliers, plan.fitted);
  list_gross_errors(calibration.estimate, fit.gross_errors, excluded, plan);
  calibration.findings = findings_left_by(diagnosis.findings, calibration.estimate.outliers);
  express_frames_relative_to_file(calibration.estimate.values, calibration.estimate.parameters, task.nominal,
                                  calibration.estimate.chain);
  calibration.model_selection = fit.model_selection;
  calibration.geometry_only = options.swarm_search.has_value();
  calibration.holdout = plan.scheme;
  calibration.gross_error_rows = excluded.rows;
  calibration.notes = make_notes(calibration.estimate, task.nominal, excluded, fit.scale, options.parameters);
  if (population.note) calibration.notes.push_back(*population.note);
  const EvaluationInputs evaluation{task.nominal, task.instrument,     task.data,    plan,
                                    frames_only,  fit.validation_fits, excluded.rows};
  fill_error_statistics(calibration, evaluation);
  calibration.chance_of_improvement = chance_of_improvement(calibration.rows, excluded.rows, task.data);
  if (const auto expected = expected_holdout_errors(evaluation)) {
    calibration.expected_holdout_rms = expected->of_fit;
    calibration.noise_holdout_rms = expected->by_noise;
  }
  calibration.tolerance_factor = fit.scale.factor;
  calibration.noise_is_stated = noise_is_stated(task);
  calibration.tolerated_error =
      primary_measurement_kind(task.data) ? max_plausible_error(task) : max_plausible_angle(task);
  if (const auto prediction = make_prediction_model(evaluation, fit.estimate, fit.beyond, options.threads)) {
    calibration.prediction = with_unobserved_tools(prediction->model, fit.estimate.chain, task.tolerances, fitted);
    calibration.predicted_holdout_rms = prediction->holdout_rms;
  }
  calibration.unobserved_lengths = find_unobserved_lengths(task, fit.estimate);
  calibration.contradiction = find_contradiction(task, fit.estimate.chain, fitted);
  calibration.least_motion = least_motion(task, frames_only, fit.estimate.chain);
  calibration.reason = judge(calibration);
  calibration.usability = usability_of(calibration.reason, calibration.unobserved_lengths);
  calibration.accuracy = evaluate_pose_accuracy(frames_only, calibration.estimate.chain, task.data);
  calibration.plot_data =
      make_plot_data(task, frames_only, calibration.estimate, calibration.prediction, options.threads);
  calibration.estimate.predicted_error = expected_error(calibration.plot_data);
  calibration.recommendations = make_recommendations(task, calibration);
  return calibration;
}

}  // namespace kinfer::calibrate
