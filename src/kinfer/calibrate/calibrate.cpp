#include "kinfer/calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/doctor.hpp"
#include "kinfer/calibrate/figures.hpp"
#include "kinfer/calibrate/iso9283.hpp"
#include "kinfer/calibrate/ladder.hpp"
#include "kinfer/calibrate/picture.hpp"
#include "kinfer/calibrate/population_fit.hpp"
#include "kinfer/calibrate/single_fit.hpp"
#include "kinfer/calibrate/surroundings.hpp"
#include "kinfer/calibrate/verdict.hpp"
#include "kinfer/calibrate/wrong_rows.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

/// The result on the fitted rows, and the fits that prove it.
struct Found {
  Estimate estimate;
  ToleranceScale scale;
  std::vector<Proof> proofs;
  Ladder ladder;
  std::vector<Outlier> wrong;  ///< rows of the whole data set that no model is to be judged by
};

/// Rows are counted in the whole data set again.
std::vector<Outlier> counted_in_all(std::vector<Outlier> outliers, const std::vector<int>& rows) {
  for (Outlier& outlier : outliers) outlier.row = rows[outlier.row];
  return outliers;
}

/// Adds those of `more` whose rows are not listed yet, ascending.
void add_rows(std::vector<Outlier>& list, const std::vector<Outlier>& more) {
  for (const Outlier& outlier : more)
    if (std::none_of(list.begin(), list.end(), [&](const Outlier& o) { return o.row == outlier.row; }))
      list.push_back(outlier);
  std::stable_sort(list.begin(), list.end(), [](const Outlier& a, const Outlier& b) { return a.row < b.row; });
}

/// Base and tool alone, fitted on each split's train rows.
Result<std::vector<Chain>> frames_without_held_out(const CalibrateTask& task, const RowsPlan& plan, int threads) {
  std::vector<Result<Chain>> fits(plan.proofs.size(), error(""));
  parallel_for(fits.size(), threads,
               [&](std::size_t i) { fits[i] = fit_frames_only(task, select(task.data, plan.proofs[i].train)); });
  std::vector<Chain> chains;
  for (const Result<Chain>& fit : fits) {
    if (!fit) return pass_on(fit.error());
    chains.push_back(*fit);
  }
  return chains;
}

/// The splits by which the ladder chooses: those of the proof, or, where the proof's rows are kept aside for good, five
/// of the fitted rows alone.
std::vector<Split> splits_of_fitted(const RowsPlan& plan, const PoseSet& fitted, Rng rng) {
  if (plan.result_sees_all_rows) return plan.proofs;
  return folds_of(fitted, std::min<int>(5, static_cast<int>(fitted.rows())), rng);
}

std::vector<Proof> proofs_of(const std::vector<Chain>& before, const std::vector<Estimate>& after) {
  std::vector<Proof> proofs;
  for (std::size_t i = 0; i < before.size(); ++i) proofs.push_back({before[i], after[i]});
  return proofs;
}

Result<Found> found_by_least_squares(const CalibrateTask& task, const RowsPlan& plan, const PoseSet& fitted,
                                     const CalibrateOptions& options, Rng rng, const Observer& observer) {
  KINFER_TRY(before, frames_without_held_out(task, plan, options.threads));
  KINFER_TRY(geometry, fit_with_believable_tolerances(task, fitted, options.parameters, rng.stream(2), observer));
  CalibrateOptions how = options;
  if (!std::holds_alternative<AutoParameters>(options.parameters)) how.model = NamedModel{};
  const Climbed climbed =
      climb(task, fitted, geometry.estimate, splits_of_fitted(plan, fitted, rng.stream(5)), how, observer);
  const std::vector<Estimate> after = plan.result_sees_all_rows ? climbed.unseen : std::vector{climbed.fit};
  KINFER_TRY(wrong, wrong_beside_geometry(task, plan, options.parameters, geometry.estimate, rng.stream(6)));
  add_rows(wrong, counted_in_all(climbed.wrong, plan.fitted));
  return Found{climbed.fit, geometry.scale, proofs_of(before, after), climbed.ladder,
               without_explained(wrong, climbed.fit, fitted, task.data)};
}

/// A population searches on the rows that the least-squares fit believes.
Result<Found> found_by_population(const CalibrateTask& task, const RowsPlan& plan, const PoseSet& fitted,
                                  const CalibrateOptions& options, Rng rng, const Observer& observer) {
  KINFER_TRY(least_squares_fit,
             fit_with_believable_tolerances(task, fitted, options.parameters, rng.stream(2), observer));
  KINFER_TRY(before, frames_without_held_out(task, plan, options.threads));
  const Rng searching = rng.stream(3), proving = rng.stream(4);
  const PoseSet believed = select(fitted, without(all_rows(fitted), least_squares_fit.estimate.outliers));
  const ToleranceScale scale = least_squares_fit.scale;
  const auto search = [&](const PoseSet& rows, Rng draws, const Observer& watching) {
    return fit_population(task, rows, options.parameters, scale, *options.population, draws, watching);
  };
  KINFER_TRY(estimate, search(believed, searching.stream(0), observer));
  estimate.outliers = least_squares_fit.estimate.outliers;
  if (std::holds_alternative<BpnnPsoOptions>(options.population->search)) {
    KINFER_TRY(runs, side_by_side(task, believed, options.parameters, scale, *options.population,
                                  least_squares_fit.estimate.chain, searching.stream(1), observer));
    estimate.search.side_by_side = runs;
  }
  const std::vector<Outlier> not_believed = counted_in_all(estimate.outliers, plan.fitted);
  KINFER_TRY(wrong, wrong_beside_geometry(task, plan, options.parameters, least_squares_fit.estimate, rng.stream(6)));
  std::vector<Result<Estimate>> after(plan.proofs.size(), error(""));
  parallel_for(after.size(), options.threads, [&](std::size_t i) {
    after[i] = search(select(task.data, without(plan.proofs[i].train, not_believed)), proving.stream(i), {});
  });
  Found found{estimate, scale, {}, {}, wrong};
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!after[i]) return pass_on(after[i].error());
    found.proofs.push_back({before[i], *after[i]});
  }
  return found;
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
    if (at.owner != Owner::base && at.owner != Owner::tool) continue;
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

void note_scale(Calibration& calibration, const ToleranceScale& scale) {
  if (scale.factor > 1.0)
    calibration.notes.push_back(fmt::format(
        "the nominal model is further off than its tolerances say: they were multiplied by {:.0f}", scale.factor));
}

/// Rows that are wrong are listed although no fit has seen them, and no figure counts them.
LeftOut leave_out_wrong_rows(Calibration& calibration, const std::vector<Outlier>& wrong, const RowsPlan& plan) {
  const LeftOut left_out = left_out_of_figures(wrong, plan);
  calibration.wrong_rows = left_out.rows;
  if (left_out.too_many)
    calibration.notes.push_back(fmt::format(
        "{} of the rows that were held out lie where no noise explains it: too many to call the rows wrong, so all "
        "count in the held-out figures",
        left_out.looking));
  std::vector<Outlier> held_out;
  for (Outlier outlier : wrong) {
    if (std::find(left_out.rows.begin(), left_out.rows.end(), outlier.row) == left_out.rows.end()) continue;
    if (std::find(plan.fitted.begin(), plan.fitted.end(), outlier.row) == plan.fitted.end())
      outlier.reason = "held out: " + outlier.reason;
    held_out.push_back(outlier);
  }
  add_rows(calibration.estimate.outliers, held_out);
  return left_out;
}

/// Which joint offsets have moved since the earlier calibration, by more than chance explains among so many.
void note_offsets(Calibration& calibration) {
  const Estimate& estimate = calibration.estimate;
  const std::vector<const Parameter*> free = estimate.parameters.free();
  const auto is_offset = [](const Parameter* p) { return p->at.owner == Owner::joint; };
  const auto offsets = static_cast<double>(std::count_if(free.begin(), free.end(), is_offset));
  const double limit = normal_quantile(1.0 - 0.005 / std::max(1.0, offsets));
  int moved = 0;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const ParameterEstimate& value = estimate.values[i];
    const double by = value.value - value.nominal;
    if (!is_offset(free[i]) || std::abs(by) <= limit * value.sd) continue;
    const bool length = value.quantity == Quantity::length;
    calibration.notes.push_back(fmt::format("{} has moved by {:+.4f} {} since the earlier calibration ({:.0f} sd)",
                                            value.name, by / (length ? 1e-3 : degree), length ? "mm" : "deg",
                                            std::abs(by) / value.sd));
    ++moved;
  }
  if (moved == 0) calibration.notes.push_back("no joint offset has moved by more than chance explains");
}

/// What one of the written files cannot say.
void note_urdf(Calibration& calibration) {
  const Chain& chain = calibration.estimate.chain;
  const auto beyond = [](const Joint& j) {
    return j.compliance != 0.0 || j.torque_compliance != 0.0 || j.backlash != 0.0 || !j.harmonics.empty();
  };
  if (chain.expansion != 0.0 || std::any_of(chain.joints.begin(), chain.joints.end(), beyond))
    calibration.notes.push_back("chain.urdf holds the geometry alone; chain.toml holds what goes beyond it");
}

}  // namespace

Result<Calibration> calibrate(const CalibrateTask& given, const CalibrateOptions& options, Rng rng,
                              const Observer& observer) {
  // The doctor judges rows of one base and one tool.
  const bool one_mounting = given.data.setups.size() < 2 && given.data.tips.empty();
  const Diagnosis diagnosis = one_mounting ? examine(given) : Diagnosis{{}, given};
  CalibrateTask task = diagnosis.treated;
  KINFER_TRY(placed, with_surroundings(task.nominal, task.data));
  task.nominal = placed.chain;
  task.data = with_approach(placed.data);
  KINFER_TRY(plan, plan_of_rows(task.data, options.holdout, rng.stream(1)));
  const PoseSet fitted = select(task.data, plan.fitted);
  KINFER_TRY(frames_only, fit_frames_only(task, fitted));
  KINFER_TRY(found, options.population ? found_by_population(task, plan, fitted, options, rng, observer)
                                       : found_by_least_squares(task, plan, fitted, options, rng, observer));

  Calibration calibration;
  calibration.findings = diagnosis.findings;
  for (const Finding& finding : diagnosis.findings)
    if (finding.kind != "gross_outliers") calibration.notes.push_back(in_words(finding));  // the fit lists its own
  calibration.estimate = found.estimate;
  calibration.ladder = found.ladder;
  express_frames_as_in_file(calibration.estimate.values, calibration.estimate.parameters, task.nominal,
                            calibration.estimate.chain);
  calibration.holdout = plan.words;
  calibration.estimate.outliers = counted_in_all(calibration.estimate.outliers, plan.fitted);
  const LeftOut left_out = leave_out_wrong_rows(calibration, found.wrong, plan);
  note_scale(calibration, found.scale);
  note_frames(calibration, task.nominal);
  note_urdf(calibration);
  if (std::holds_alternative<OffsetParameters>(options.parameters)) note_offsets(calibration);
  calibration.geometry_alone = options.population.has_value();
  const Judged judged{task.nominal, task.instrument, task.data, plan, frames_only, found.proofs, left_out.rows};
  fill_figures(calibration, judged);
  judge(calibration, expected_error(judged));
  calibration.accuracy = pose_accuracy(frames_only, calibration.estimate.chain, task.data);
  calibration.picture = calibration_picture(task, frames_only, calibration.estimate);
  calibration.next = calibration_advice(task, calibration);
  return calibration;
}

}  // namespace kinfer
