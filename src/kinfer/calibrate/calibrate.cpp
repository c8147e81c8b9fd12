// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/conclusion/plot_data.hpp"
#include "kinfer/calibrate/conclusion/verdict.hpp"
#include "kinfer/calibrate/diagnosis/diagnose.hpp"
#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/calibrate/swarm/swarm_fit.hpp"
#include "kinfer/calibrate/terms/model_selection.hpp"
#include "kinfer/calibrate/validation/gross_errors.hpp"
#include "kinfer/calibrate/validation/iso9283.hpp"
#include "kinfer/calibrate/validation/validation_errors.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::calibrate {
namespace {

/// The result on the fitted rows, and the fits that validate it.
struct CalibrationFit {
  Estimate estimate;
  ToleranceScale scale;
  std::vector<ValidationFit> proofs;
  ModelSelection model_selection;
  std::vector<Outlier> gross_errors;  ///< rows of the whole data set with gross errors, excluded from every evaluation
};

/// Converts row indices from the subset `rows` to the whole data set.
std::vector<Outlier> with_data_rows(std::vector<Outlier> outliers, const std::vector<int>& rows) {
  for (Outlier& outlier : outliers) outlier.row = rows[outlier.row];
  return outliers;
}

/// Adds the entries of `more` whose rows are not listed yet; sorted by row.
void merge_outliers(std::vector<Outlier>& list, const std::vector<Outlier>& more) {
  for (const Outlier& outlier : more)
    if (std::none_of(list.begin(), list.end(), [&](const Outlier& o) { return o.row == outlier.row; }))
      list.push_back(outlier);
  std::stable_sort(list.begin(), list.end(), [](const Outlier& a, const Outlier& b) { return a.row < b.row; });
}

/// Base and tool only, fitted to each split's training rows.
Result<std::vector<Chain>> fit_frames_of_splits(const CalibrationTask& task, const ValidationPlan& plan, int threads) {
  std::vector<Result<Chain>> fits(plan.proofs.size(), error(""));
  parallel_for(fits.size(), threads,
               [&](std::size_t i) { fits[i] = fit_frames_only(task, select(task.data, plan.proofs[i].train)); });
  std::vector<Chain> chains;
  for (const Result<Chain>& fit : fits) {
    if (!fit) return forward_error(fit.error());
    chains.push_back(*fit);
  }
  return chains;
}

/// The splits for model selection: those of the validation, or, where the validation rows are never fitted, five
/// folds of the fitted rows.
std::vector<Split> selection_splits(const ValidationPlan& plan, const PoseSet& fitted, Rng rng) {
  if (plan.fits_all_rows) return plan.proofs;
  return make_row_folds(fitted, std::min<int>(5, static_cast<int>(fitted.rows())), rng);
}

std::vector<ValidationFit> pair_validation_fits(const std::vector<Chain>& before, const std::vector<Estimate>& after) {
  std::vector<ValidationFit> proofs;
  for (std::size_t i = 0; i < before.size(); ++i) proofs.push_back({before[i], after[i]});
  return proofs;
}

Result<CalibrationFit> calibrate_by_least_squares(const CalibrationTask& task, const ValidationPlan& plan,
                                                  const PoseSet& fitted, const CalibrationOptions& options, Rng rng,
                                                  const Observer& observer) {
  KINFER_TRY(before, fit_frames_of_splits(task, plan, options.threads));
  KINFER_TRY(geometry, fit_with_scaled_tolerances(task, fitted, options.parameters, rng.stream(2), observer));
  CalibrationOptions selection_options = options;
  if (!std::holds_alternative<GeometricParameters>(options.parameters)) selection_options.model = FixedModel{};
  const SelectedModel selected_model = select_model(
      task, fitted, geometry.estimate, selection_splits(plan, fitted, rng.stream(5)), selection_options, observer);
  const std::vector<Estimate> after = plan.fits_all_rows ? selected_model.split_fits : std::vector{selected_model.fit};
  KINFER_TRY(gross_errors, find_gross_errors(task, plan, options.parameters, geometry.estimate, rng.stream(6)));
  merge_outliers(gross_errors, with_data_rows(selected_model.gross_errors, plan.fitted));
  return CalibrationFit{selected_model.fit, geometry.scale, pair_validation_fits(before, after),
                        selected_model.model_selection,
                        without_explained_rows(gross_errors, selected_model.fit, fitted, task.data)};
}

/// Swarm search on the inlier rows of the least-squares fit.
Result<CalibrationFit> calibrate_by_swarm(const CalibrationTask& task, const ValidationPlan& plan,
                                          const PoseSet& fitted, const CalibrationOptions& options, Rng rng,
                                          const Observer& observer) {
  KINFER_TRY(least_squares_fit, fit_with_scaled_tolerances(task, fitted, options.parameters, rng.stream(2), observer));
  KINFER_TRY(before, fit_frames_of_splits(task, plan, options.threads));
  const Rng search_rng = rng.stream(3), validation_rng = rng.stream(4);
  const PoseSet inliers = select(fitted, without(all_rows(fitted), least_squares_fit.estimate.outliers));
  const ToleranceScale scale = least_squares_fit.scale;
  const auto search = [&](const PoseSet& rows, Rng draws, const Observer& search_observer) {
    return fit_by_swarm(task, rows, options.parameters, scale, *options.swarm_search, draws, search_observer);
  };
  KINFER_TRY(estimate, search(inliers, search_rng.stream(0), observer));
  estimate.outliers = least_squares_fit.estimate.outliers;
  if (std::holds_alternative<BpnnPsoOptions>(options.swarm_search->search)) {
    KINFER_TRY(runs, swarm_comparison(task, inliers, options.parameters, scale, *options.swarm_search,
                                      least_squares_fit.estimate.chain, search_rng.stream(1), observer));
    estimate.search.swarm_comparison = runs;
  }
  const std::vector<Outlier> data_outliers = with_data_rows(estimate.outliers, plan.fitted);
  KINFER_TRY(gross_errors,
             find_gross_errors(task, plan, options.parameters, least_squares_fit.estimate, rng.stream(6)));
  std::vector<Result<Estimate>> after(plan.proofs.size(), error(""));
  parallel_for(after.size(), options.threads, [&](std::size_t i) {
    after[i] = search(select(task.data, without(plan.proofs[i].train, data_outliers)), validation_rng.stream(i), {});
  });
  CalibrationFit calibrated{estimate, scale, {}, {}, gross_errors};
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!after[i]) return forward_error(after[i].error());
    calibrated.proofs.push_back({before[i], *after[i]});
  }
  return calibrated;
}

/// Expresses base and tool relative to the frames of the file; the fit itself is relative to the frames from the data.
void express_frames_relative_to_file(std::vector<ParameterEstimate>& values, const ParameterSet& set, const Chain& file,
                                     const Chain& calibrated) {
  const auto coordinate = [](const Frame& from, const Frame& to, Field field) {
    const auto k = static_cast<int>(field);
    if (field <= Field::z) return std::pair{from.xyz[k], to.xyz[k]};
    const Vec3 turn = to_intrinsic_xyz(from.pose().rotation.transpose() * to.pose().rotation);
    return std::pair{0.0, turn[k - static_cast<int>(Field::rx)]};
  };
  const std::vector<const Parameter*> free = set.free();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const ParameterAddress& at = free[i]->at;
    if (at.owner != Owner::base && at.owner != Owner::tool) continue;
    const bool base = at.owner == Owner::base;
    std::tie(values[i].nominal, values[i].value) =
        coordinate(base ? file.base : file.tool, base ? calibrated.base : calibrated.tool, at.field);
  }
}

/// Adds a note where base and tool were not free parameters but the frames of the file were not used.
void note_frames(Calibration& calibration, const Chain& nominal) {
  for (const ParameterEstimate& p : calibration.estimate.values)
    if (p.name == "base_x") return;
  const double off = (calibration.estimate.chain.base.xyz - nominal.base.xyz).norm();
  if (off > 0.0)
    calibration.notes.push_back(fmt::format(
        "the base of the robot file lies {:.1f} mm from where the data show it: base and tool were taken from the data",
        1e3 * off));
}

void note_scale(Calibration& calibration, const ToleranceScale& scale) {
  if (scale.factor > 1.0)
    calibration.notes.push_back(fmt::format(
        "the nominal model is further off than its tolerances say: they were multiplied by {:.0f}", scale.factor));
}

/// Lists held-out rows with gross errors among the outliers and excludes them from the hold-out figures.
ExcludedRows exclude_gross_errors(Calibration& calibration, const std::vector<Outlier>& gross_errors,
                                  const ValidationPlan& plan) {
  const ExcludedRows excluded = select_excluded_rows(gross_errors, plan);
  calibration.gross_error_rows = excluded.rows;
  if (excluded.too_many)
    calibration.notes.push_back(fmt::format(
        "{} of the rows that were held out lie where no noise explains it: too many to call the rows wrong, so all "
        "count in the held-out figures",
        excluded.suspect_count));
  std::vector<Outlier> held_out;
  for (Outlier outlier : gross_errors) {
    if (std::find(excluded.rows.begin(), excluded.rows.end(), outlier.row) == excluded.rows.end()) continue;
    if (std::find(plan.fitted.begin(), plan.fitted.end(), outlier.row) == plan.fitted.end())
      outlier.reason = "held out: " + outlier.reason;
    held_out.push_back(outlier);
  }
  merge_outliers(calibration.estimate.outliers, held_out);
  return excluded;
}

/// Which joint offsets have changed significantly since the earlier calibration (two-sided, 1 % family-wise).
void note_offsets(Calibration& calibration) {
  const Estimate& estimate = calibration.estimate;
  const std::vector<const Parameter*> free = estimate.parameters.free();
  const auto is_offset = [](const Parameter* p) { return p->at.owner == Owner::joint; };
  const auto offsets = static_cast<double>(std::count_if(free.begin(), free.end(), is_offset));
  const double limit = normal_quantile(1.0 - 0.005 / std::max(1.0, offsets));
  int changed_count = 0;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const ParameterEstimate& value = estimate.values[i];
    const double by = value.value - value.nominal;
    if (!is_offset(free[i]) || std::abs(by) <= limit * value.sd) continue;
    const bool length = value.quantity == Quantity::length;
    calibration.notes.push_back(fmt::format("{} has moved by {:+.4f} {} since the earlier calibration ({:.0f} sd)",
                                            value.name, by / (length ? 1e-3 : degree), length ? "mm" : "deg",
                                            std::abs(by) / value.sd));
    ++changed_count;
  }
  if (changed_count == 0) calibration.notes.push_back("no joint offset has moved by more than chance explains");
}

/// Adds a note where the URDF cannot represent the whole model.
void note_urdf(Calibration& calibration) {
  const Chain& chain = calibration.estimate.chain;
  const auto is_non_geometric = [](const Joint& j) {
    return j.compliance != 0.0 || j.torque_compliance != 0.0 || j.backlash != 0.0 || !j.harmonics.empty();
  };
  if (chain.expansion != 0.0 || std::any_of(chain.joints.begin(), chain.joints.end(), is_non_geometric))
    calibration.notes.push_back("chain.urdf holds the geometry alone; chain.toml holds what goes beyond it");
}

}  // namespace

Result<Calibration> calibrate_robot(const CalibrationTask& given, const CalibrationOptions& options, Rng rng,
                                    const Observer& observer) {
  // The diagnosis assumes a single base and a single tool.
  const bool one_mounting = given.data.setups.size() < 2 && given.data.tips.empty();
  const Diagnosis diagnosis = one_mounting ? diagnose(given) : Diagnosis{{}, given};
  CalibrationTask task = diagnosis.corrected_task;
  KINFER_TRY(placed, with_fixtures(task.nominal, task.data));
  task.nominal = placed.chain;
  task.data = with_approach(placed.data);
  KINFER_TRY(plan, make_validation_plan(task.data, options.holdout, rng.stream(1)));
  const PoseSet fitted = select(task.data, plan.fitted);
  KINFER_TRY(frames_only, fit_frames_only(task, fitted));
  KINFER_TRY(calibrated, options.swarm_search ? calibrate_by_swarm(task, plan, fitted, options, rng, observer)
                                              : calibrate_by_least_squares(task, plan, fitted, options, rng, observer));

  Calibration calibration;
  calibration.findings = diagnosis.findings;
  for (const Finding& finding : diagnosis.findings)
    if (finding.kind != FindingKind::gross_outliers)
      calibration.notes.push_back(describe_finding(finding));  // the fit lists its outliers
  calibration.estimate = calibrated.estimate;
  calibration.model_selection = calibrated.model_selection;
  express_frames_relative_to_file(calibration.estimate.values, calibration.estimate.parameters, task.nominal,
                                  calibration.estimate.chain);
  calibration.holdout = plan.words;
  calibration.estimate.outliers = with_data_rows(calibration.estimate.outliers, plan.fitted);
  const ExcludedRows excluded = exclude_gross_errors(calibration, calibrated.gross_errors, plan);
  note_scale(calibration, calibrated.scale);
  note_frames(calibration, task.nominal);
  note_urdf(calibration);
  if (std::holds_alternative<JointOffsetParameters>(options.parameters)) note_offsets(calibration);
  calibration.geometry_only = options.swarm_search.has_value();
  const EvaluationInputs evaluation{task.nominal, task.instrument,   task.data,    plan,
                                    frames_only,  calibrated.proofs, excluded.rows};
  fill_error_statistics(calibration, evaluation);
  write_verdict(calibration, expected_holdout_rms(evaluation));
  calibration.accuracy = evaluate_pose_accuracy(frames_only, calibration.estimate.chain, task.data);
  calibration.plot_data = make_plot_data(task, frames_only, calibration.estimate);
  calibration.recommendations = make_recommendations(task, calibration);
  return calibration;
}

}  // namespace kinfer::calibrate
