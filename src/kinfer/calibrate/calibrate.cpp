#include "kinfer/calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/picture.hpp"
#include "kinfer/calibrate/population_fit.hpp"
#include "kinfer/calibrate/single_fit.hpp"
#include "kinfer/calibrate/verdict.hpp"
#include "kinfer/estimate/bundle.hpp"

namespace kinfer {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// Which rows are fitted for the result, and which splits prove it.
struct Plan {
  std::vector<int> fitted;
  std::vector<Split> proofs;
  std::string words;
  bool result_sees_all_rows = true;
};

std::vector<int> all_rows(const PoseSet& data) {
  std::vector<int> rows(data.rows());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
  return rows;
}

bool has_held_out_labels(const PoseSet& data) {
  return std::find(data.set.begin(), data.set.end(), SetLabel::holdout) != data.set.end();
}

Plan plan_by_labels(const PoseSet& data) {
  Split split;
  for (int row = 0; row < data.rows(); ++row)
    (data.set[row] == SetLabel::holdout ? split.holdout : split.train).push_back(row);
  return {split.train, {split}, "rows marked holdout", false};
}

Result<Plan> plan(const PoseSet& data, const HoldoutChoice& choice, Rng rng) {
  const auto count = static_cast<int>(data.rows());
  if (const auto* part = std::get_if<HeldOutFraction>(&choice)) {
    const Split split = random_split(count, part->fraction, rng);
    return Plan{
        split.train, {split}, fmt::format("{:.0f} % of the rows, drawn at random", 100.0 * part->fraction), false};
  }
  if (has_held_out_labels(data)) return plan_by_labels(data);
  if (std::holds_alternative<HeldOutByLabel>(choice)) return error("no row is marked holdout in a column called set");
  const int k = std::min(std::get<CrossValidation>(choice).folds, count);
  return Plan{all_rows(data), folds(count, k, rng), fmt::format("{}-fold cross-validation", k), true};
}

/// Position error of each row [m] (the mean over its targets) and all errors of the listed rows.
struct Errors {
  std::vector<double> position_of_row;
  ErrorStatistics position, orientation;
};

Errors errors_of(const Chain& chain, const PoseSet& rows) {
  Errors errors;
  const std::vector<double> points = point_errors(chain, rows);
  std::vector<double> sum(rows.rows(), 0.0), count(rows.rows(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i)
    sum[rows.points[i].row] += points[i], count[rows.points[i].row] += 1.0;
  for (std::size_t row = 0; row < sum.size(); ++row)
    errors.position_of_row.push_back(count[row] > 0.0 ? sum[row] / count[row] : not_measured);
  errors.position = error_statistics(points);
  errors.orientation = error_statistics(orientation_errors(chain, rows));
  return errors;
}

/// The rows without those that the final fit does not believe.
std::vector<int> without(std::vector<int> rows, const std::vector<Outlier>& outliers) {
  std::set<int> wrong;
  for (const Outlier& outlier : outliers) wrong.insert(outlier.row);
  std::erase_if(rows, [&](int row) { return wrong.contains(row); });
  return rows;
}

struct Proof {
  Chain before;
  Estimate after;
  Error failure;
};

/// Rows are counted in the whole data set again.
void map_rows_back(std::vector<Outlier>& outliers, const std::vector<int>& rows) {
  for (Outlier& outlier : outliers) outlier.row = rows[outlier.row];
}

/// The estimate by the method that was asked for.
Result<Estimate> fit_by_method(const CalibrateTask& task, const PoseSet& rows, const CalibrateOptions& options,
                               ToleranceScale scale, Rng rng, const Observer& observer = {}) {
  return options.population ? fit_population(task, rows, options.parameters, scale, *options.population, rng, observer)
                            : fit_once(task, rows, options.parameters, scale, observer);
}

/// Where a population is to search: it does so on the rows that the least-squares fit believes.
Result<ScaledFit> with_population(const CalibrateTask& task, const PoseSet& rows, const CalibrateOptions& options,
                                  const ScaledFit& found, Rng rng, const Observer& observer) {
  if (!options.population) return found;
  const PoseSet believed = select(rows, without(all_rows(rows), found.estimate.outliers));
  KINFER_TRY(estimate, fit_by_method(task, believed, options, found.scale, rng.stream(0), observer));
  estimate.outliers = found.estimate.outliers;
  if (std::holds_alternative<BpnnPsoOptions>(options.population->search)) {
    KINFER_TRY(runs, side_by_side(task, believed, options.parameters, found.scale, *options.population,
                                  found.estimate.chain, rng.stream(1), observer));
    estimate.search.side_by_side = runs;
  }
  return ScaledFit{estimate, found.scale};
}

/// Fits each split's train rows, without the rows' help that are held out.
Result<std::vector<Proof>> prove(const CalibrateTask& task, const Plan& plan, const CalibrateOptions& options,
                                 const ScaledFit& found, Rng rng) {
  std::vector<Outlier> not_believed = found.estimate.outliers;
  map_rows_back(not_believed, plan.fitted);
  std::vector<Proof> proofs(plan.proofs.size());
  parallel_for(proofs.size(), options.threads, [&](std::size_t i) {
    const PoseSet rows = select(task.data, plan.proofs[i].train);
    const PoseSet searched = options.population ? select(task.data, without(plan.proofs[i].train, not_believed)) : rows;
    const Result<Chain> before = fit_frames_only(task, rows);
    const Result<Estimate> after = fit_by_method(task, searched, options, found.scale, rng.stream(i));
    if (!before)
      proofs[i].failure = before.error();
    else if (!after)
      proofs[i].failure = after.error();
    else
      proofs[i] = {*before, *after, {}};
  });
  for (const Proof& proof : proofs)
    if (!proof.failure.what.empty()) return pass_on(proof.failure);
  return proofs;
}

/// Gathers the errors of held-out rows over all splits.
struct HeldOutErrors {
  std::vector<double> nominal, before, after;                 // [m]
  std::vector<double> turn_nominal, turn_before, turn_after;  // [rad]

  void add(const Chain& given, const Proof& proof, const PoseSet& rows) {
    append(nominal, point_errors(given, rows));
    append(before, point_errors(proof.before, rows));
    append(after, point_errors(proof.after.chain, rows));
    append(turn_nominal, orientation_errors(given, rows));
    append(turn_before, orientation_errors(proof.before, rows));
    append(turn_after, orientation_errors(proof.after.chain, rows));
  }
  static void append(std::vector<double>& to, const std::vector<double>& more) {
    to.insert(to.end(), more.begin(), more.end());
  }
};

void fill_figures(Calibration& calibration, const CalibrateTask& task, const Plan& plan, const Chain& frames_only,
                  const std::vector<Proof>& proofs) {
  const std::vector<Outlier>& outliers = calibration.estimate.outliers;
  const PoseSet fitted = select(task.data, without(plan.fitted, outliers));
  const auto train = [&](const Chain& chain, ChainFit& fit) {
    const Errors errors = errors_of(chain, fitted);
    fit.position.train = errors.position;
    fit.orientation.train = errors.orientation;
  };
  train(task.nominal, calibration.nominal);
  train(frames_only, calibration.before);
  train(calibration.estimate.chain, calibration.after);

  HeldOutErrors held_out;
  for (std::size_t i = 0; i < proofs.size(); ++i)
    held_out.add(task.nominal, proofs[i], select(task.data, without(plan.proofs[i].holdout, outliers)));
  calibration.nominal.position.holdout = error_statistics(held_out.nominal);
  calibration.before.position.holdout = error_statistics(held_out.before);
  calibration.after.position.holdout = error_statistics(held_out.after);
  calibration.nominal.orientation.holdout = error_statistics(held_out.turn_nominal);
  calibration.before.orientation.holdout = error_statistics(held_out.turn_before);
  calibration.after.orientation.holdout = error_statistics(held_out.turn_after);
}

void fill_rows(Calibration& calibration, const CalibrateTask& task, const Plan& plan, const Chain& frames_only,
               const std::vector<Proof>& proofs) {
  const Errors before = errors_of(frames_only, task.data), after = errors_of(calibration.estimate.chain, task.data);
  for (int row = 0; row < task.data.rows(); ++row)
    calibration.rows.push_back(
        {row, before.position_of_row[row], after.position_of_row[row], after.position_of_row[row], false});
  for (std::size_t i = 0; i < proofs.size(); ++i) {
    const PoseSet rows = select(task.data, plan.proofs[i].holdout);
    const Errors unseen_before = errors_of(proofs[i].before, rows),
                 unseen_after = errors_of(proofs[i].after.chain, rows);
    for (std::size_t k = 0; k < plan.proofs[i].holdout.size(); ++k) {
      RowErrors& entry = calibration.rows[plan.proofs[i].holdout[k]];
      entry.before = unseen_before.position_of_row[k];
      entry.after = unseen_after.position_of_row[k];
      entry.held_out = true;
    }
  }
}

/// Base and tool as seen from the frames of the file: the fit itself counts from the frames that the data showed.
void express_frames_as_in_file(std::vector<ParameterEstimate>& values, const ParameterSet& set, const Chain& file,
                               const Chain& found) {
  const auto place = [](const Frame& from, const Frame& to, Field field) {
    const auto k = static_cast<int>(field);
    if (field <= Field::z) return std::pair{from.xyz[k], to.xyz[k]};
    const Vec3 turn = to_intrinsic_xyz(from.pose().rotation.transpose() * to.pose().rotation);
    return std::pair{0.0, turn[k - static_cast<int>(Field::rx)]};
  };
  const std::vector<const Parameter*> free = set.free();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Address& at = free[i]->at;
    if (at.owner == Owner::joint) continue;
    const bool base = at.owner == Owner::base;
    std::tie(values[i].nominal, values[i].value) =
        place(base ? file.base : file.tool, base ? found.base : found.tool, at.field);
  }
}

/// Says so where base and tool were no parameters, and yet those of the file were not used.
void note_frames(Calibration& calibration, const Chain& nominal) {
  for (const ParameterEstimate& p : calibration.estimate.values)
    if (p.name == "base_x") return;
  const double off = (calibration.estimate.chain.base.xyz - nominal.base.xyz).norm();
  if (off > 0.0)
    calibration.notes.push_back(fmt::format(
        "the base of the robot file lies {:.1f} mm from where the data show it: base and tool were taken from the data",
        1e3 * off));
}

/// Rms error that the held-out rows should show [m]: the instrument's scatter and the uncertainty of the fits that did
/// not see them. Nothing where the instrument is not known.
std::optional<double> expected_error(const CalibrateTask& task, const Plan& plan, const std::vector<Proof>& proofs,
                                     const std::vector<Outlier>& outliers) {
  if (!task.instrument) return std::nullopt;
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < proofs.size(); ++i) {
    const PoseSet rows = select(task.data, without(plan.proofs[i].holdout, outliers));
    const Weights promised = weights_of(rows, *task.instrument);
    for (std::size_t k = 0; k < rows.points.size(); ++k) {
      const auto q = rows.joints.col(rows.points[k].row);
      squares += promised.point_sd[k].squaredNorm() + predicted_covariance(proofs[i].after, q).trace();
      count += 1.0;
    }
  }
  return count > 0.0 ? std::optional(std::sqrt(squares / count)) : std::nullopt;
}

Result<void> enough_rows(const CalibrateTask& task, const Plan& plan) {
  // Each pose gives at most six equations; base and tool alone are nine unknowns, and one row must prove the result.
  constexpr int fewest = 4;
  if (static_cast<int>(plan.fitted.size()) < fewest)
    return error("{} rows are left to fit; a calibration needs at least {} (20 or more are better)", plan.fitted.size(),
                 fewest);
  for (const Split& split : plan.proofs)
    if (split.train.size() < 3)
      return error("{} rows are too few to fit and prove a calibration; at least 4 are needed", task.data.rows());
  return {};
}

}  // namespace

Result<Calibration> calibrate(const CalibrateTask& task, const CalibrateOptions& options, Rng rng,
                              const Observer& observer) {
  KINFER_TRY(plan_of_rows, plan(task.data, options.holdout, rng.stream(1)));
  if (auto enough = enough_rows(task, plan_of_rows); !enough) return pass_on(enough.error());
  const PoseSet fitted = select(task.data, plan_of_rows.fitted);
  KINFER_TRY(frames_only, fit_frames_only(task, fitted));
  KINFER_TRY(least_squares_fit,
             fit_with_believable_tolerances(task, fitted, options.parameters, rng.stream(2), observer));
  KINFER_TRY(found, with_population(task, fitted, options, least_squares_fit, rng.stream(3), observer));
  KINFER_TRY(proofs, prove(task, plan_of_rows, options, found, rng.stream(4)));

  Calibration calibration;
  calibration.estimate = found.estimate;
  express_frames_as_in_file(calibration.estimate.values, calibration.estimate.parameters, task.nominal,
                            calibration.estimate.chain);
  calibration.holdout = plan_of_rows.words;
  map_rows_back(calibration.estimate.outliers, plan_of_rows.fitted);
  if (found.scale.factor > 1.0)
    calibration.notes.push_back(
        fmt::format("the nominal model is further off than its tolerances say: they were multiplied by {:.0f}",
                    found.scale.factor));
  note_frames(calibration, task.nominal);
  fill_figures(calibration, task, plan_of_rows, frames_only, proofs);
  fill_rows(calibration, task, plan_of_rows, frames_only, proofs);
  judge(calibration, expected_error(task, plan_of_rows, proofs, calibration.estimate.outliers));
  calibration.picture = calibration_picture(task, frames_only, calibration.estimate);
  calibration.next = calibration_advice(task, calibration);
  return calibration;
}

}  // namespace kinfer
