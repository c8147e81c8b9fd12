// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/row_pairing.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "kinfer/calibrate/diagnosis/thresholds.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

constexpr int no_shift = 0;  // shift of a correctly paired row

/// Joint positions of row i + shift paired with the measurements of row i; rows without a partner are omitted.
PoseSet shifted_window(const PoseSet& data, int begin, int count, int shift) {
  std::vector<int> measured, read;
  for (int row = begin; row < begin + count; ++row)
    if (row + shift >= 0 && row + shift < data.rows()) measured.push_back(row), read.push_back(row + shift);
  PoseSet window = select(data, measured);
  window.joints = data.joints(Eigen::all, read);
  window.orientations.clear();
  return window;
}

/// A chain that explains at least some of the rows, and the error up to which a row counts as explained [m].
struct ReferenceModel {
  Chain chain;
  double limit = 0.0;
};

std::optional<ReferenceModel> reference_from_all_rows(const CalibrationTask& task, double plausible_error) {
  const auto fit = fit_frames_quickly(task.nominal, thin_pose_set(task.data, thresholds::reference_rows));
  if (!fit || fit->median_error > plausible_error) return std::nullopt;
  return ReferenceModel{fit->chain, std::max(plausible_error, thresholds::unpaired_ratio * fit->median_error)};
}

std::optional<ReferenceModel> reference_from_windows(const CalibrationTask& task, double plausible_error) {
  const auto count = static_cast<int>(task.data.rows());
  const int width = std::clamp(count / 4, 8, 20), max_shift = std::min(thresholds::largest_shift, count / 4);
  std::optional<ReferenceModel> best;
  double best_typical = plausible_error;
  for (int begin = 0; begin + width <= count; begin += std::max(1, (count - width) / 3))
    for (int shift = -max_shift; shift <= max_shift; ++shift) {
      const PoseSet window = shifted_window(task.data, begin, width, shift);
      if (window.rows() < 8 || window.points.size() < 8) continue;
      const auto fit = fit_frames_quickly(task.nominal, window);
      if (!fit || fit->median_error > best_typical) continue;
      best_typical = fit->median_error;
      best = ReferenceModel{fit->chain, plausible_error};
    }
  return best;
}

/// error(i, j) [m]: distance of the measurement of row i from the tool at the joint positions of row j; NaN: not
/// measured.
class PairErrors {
 public:
  PairErrors(const Chain& chain, const PoseSet& data)
      : data_(data), at_(evaluate_poses(chain, {}, data, Derivative::no)) {
    of_row_.resize(data.rows());
    for (const PointMeasurement& point : data.points) of_row_[point.row].push_back(&point);
    for (const Target& target : chain.targets) targets_.push_back(target.xyz);
  }
  bool measured(int row) const { return !of_row_[row].empty(); }
  double operator()(int measured, int read) const {
    if (read < 0 || read >= data_.rows() || of_row_[measured].empty()) return std::nan("");
    double largest = 0.0;
    for (const PointMeasurement* point : of_row_[measured]) {
      const Vec3 in_tool = point->target < 0 ? Vec3::Zero().eval() : targets_[point->target];
      largest = std::max(largest, (point->position - at_.pose[read] * in_tool).norm());
    }
    return largest;
  }

 private:
  const PoseSet& data_;
  EvaluatedPoses at_;
  std::vector<std::vector<const PointMeasurement*>> of_row_;
  std::vector<Vec3> targets_;
};

/// For the measurement of each row, the row whose joint positions belong to it; −1: none in the file.
struct Partners {
  std::vector<int> of;
  std::vector<bool> explained;
};

/// The longest run of unexplained rows that one shift explains; at most one row in five may disagree.
struct Run {
  int shift = no_shift, begin = 0, end = 0;  // rows begin .. end − 1
  std::vector<int> rows;                     // that are explained
};

Run longest_run(const PairErrors& error, const Partners& partners, double limit, int shift) {
  Run best, now;
  const auto close = [&] {
    if (now.rows.size() > best.rows.size()) best = now;
    now = {};
  };
  int disagree = 0;
  for (int row = 0; row < static_cast<int>(partners.of.size()); ++row) {
    if (!error.measured(row)) continue;
    const bool explained = !partners.explained[row] && error(row, row + shift) <= limit;
    if (explained) {
      if (now.rows.empty()) now.shift = shift, now.begin = row, disagree = 0;
      now.rows.push_back(row);
      now.end = row + 1;
    } else if (!now.rows.empty() &&
               thresholds::max_disagreeing * static_cast<std::size_t>(++disagree) > now.rows.size() + 4) {
      close();
    }
  }
  close();
  return best;
}

/// Unexplained rows next to the run whose joint positions are missing from the file because of the shift.
std::vector<int> lost_rows(const Run& run, const Partners& partners) {
  const int count = static_cast<int>(partners.of.size());
  const int first = run.shift > 0 ? run.end : run.begin + run.shift;
  std::vector<int> lost;
  for (int row = std::max(0, first); row < std::min(count, first + std::abs(run.shift)); ++row)
    if (!partners.explained[row]) lost.push_back(row);
  return lost;
}

void report_shift(DiagnosisState& state, const Run& run, const std::vector<int>& lost) {
  std::vector<int> rows = run.rows;
  rows.insert(rows.end(), lost.begin(), lost.end());
  std::sort(rows.begin(), rows.end());
  const bool whole = rows.size() + 2 >= static_cast<std::size_t>(state.task.data.rows());
  add_finding(state, {.kind = FindingKind::rows_shifted,
                      .severity = Severity::fault,
                      .rows = rows,
                      .values = {{"shift", run.shift}, {"whole_set", whole ? 1 : 0}},
                      .applied = true});
}

void find_shifts(DiagnosisState& state, const PairErrors& error, double limit, Partners& partners) {
  const int count = static_cast<int>(partners.of.size()), max_shift = std::min(thresholds::largest_shift, count / 4);
  for (;;) {
    Run best;
    for (int shift = -max_shift; shift <= max_shift; ++shift) {
      if (shift == no_shift) continue;
      const Run run = longest_run(error, partners, limit, shift);
      if (run.rows.size() > best.rows.size()) best = run;
    }
    if (static_cast<int>(best.rows.size()) < thresholds::min_shifted_run) return;
    for (int row = best.begin; row < best.end; ++row)
      partners.of[row] = row + best.shift, partners.explained[row] = true;
    const std::vector<int> lost = lost_rows(best, partners);
    for (const int row : lost) partners.of[row] = -1, partners.explained[row] = true;
    report_shift(state, best, lost);
  }
}

/// The only row among `candidates` whose joint positions explain the measurement of `row`; −1: none, or several.
int only_partner(const PairErrors& error, int row, const std::vector<int>& candidates, double limit) {
  int found = -1;
  for (const int other : candidates) {
    if (other == row || !(error(row, other) <= limit)) continue;
    if (found >= 0) return -1;
    found = other;
  }
  return found;
}

void find_swapped_rows(DiagnosisState& state, const PairErrors& error, double limit, Partners& partners) {
  std::vector<int> open;
  for (int row = 0; row < static_cast<int>(partners.of.size()); ++row)
    if (!partners.explained[row]) open.push_back(row);
  for (const int row : open) {
    if (partners.explained[row]) continue;
    const int other = only_partner(error, row, open, limit);
    if (other < 0 || partners.explained[other] || only_partner(error, other, open, limit) != row) continue;
    partners.explained[row] = partners.explained[other] = true;
    add_finding(state, {.kind = FindingKind::rows_swapped, .severity = Severity::warning, .rows = {row, other}});
  }
}

/// Rows, mostly adjacent, that another pose of base and tool explains: something was moved in between.
void find_moved_base(DiagnosisState& state, const ReferenceModel& reference, const PairErrors& error,
                     Partners& partners) {
  std::vector<int> open;
  for (int row = 0; row < static_cast<int>(partners.of.size()); ++row)
    if (!partners.explained[row]) open.push_back(row);
  if (open.size() < thresholds::min_moved_rows || open.back() - open.front() > 2 * static_cast<int>(open.size()))
    return;
  PoseSet block = select(state.task.data, open);
  block.orientations.clear();
  const auto fit = fit_frames_quickly(state.task.nominal, block);
  if (!fit || fit->median_error > reference.limit) return;
  std::vector<double> moved;
  for (const int row : open) moved.push_back(error(row, row));
  for (const int row : open) partners.explained[row] = true;
  add_finding(state, {.kind = FindingKind::base_moved,
                      .severity = Severity::fault,
                      .rows = open,
                      .values = {{"distance_m", median(moved)}}});
}

void apply_pairing(PoseSet& data, const std::vector<int>& partner) {
  const PoseSet before = data;
  for (int row = 0; row < data.rows(); ++row) {
    if (partner[row] == row || partner[row] < 0) continue;
    data.joints.col(row) = before.joints.col(partner[row]);
    if (data.commanded.size() > 0) data.commanded.col(row) = before.commanded.col(partner[row]);
    if (data.torques.size() > 0) data.torques.col(row) = before.torques.col(partner[row]);
  }
  const auto lost = [&](const auto& measurement) { return partner[measurement.row] < 0; };
  for_each_list(data, [&](auto& list) { std::erase_if(list, lost); });
  std::erase_if(data.pairs, [&](const PairDistance& pair) { return partner[pair.other] < 0; });
}

}  // namespace

PairingEvaluated check_pairing(DiagnosisState& state) {
  const CalibrationTask& task = state.task;
  if (task.data.points.empty() || task.data.rows() < thresholds::min_pairing_rows) return PairingEvaluated::no;
  const double plausible_error = max_plausible_error(task);
  auto reference = reference_from_all_rows(task, plausible_error);
  if (!reference) reference = reference_from_windows(task, plausible_error);
  if (!reference) return PairingEvaluated::no;
  const PairErrors error(reference->chain, task.data);
  Partners partners;
  for (int row = 0; row < task.data.rows(); ++row) {
    partners.of.push_back(row);
    partners.explained.push_back(!error.measured(row) || error(row, row) <= reference->limit);
  }
  const std::size_t findings_before = state.findings.size();
  find_shifts(state, error, reference->limit, partners);
  const auto explained = std::count(partners.explained.begin(), partners.explained.end(), true);
  if (explained <
      static_cast<Eigen::Index>(
          thresholds::min_explained_part *
          static_cast<double>(task.data.rows()))) {  // a run in which the faulty joint did not move fits by chance
    state.findings.resize(findings_before);
    return PairingEvaluated::no;
  }
  find_swapped_rows(state, error, reference->limit, partners);
  find_moved_base(state, *reference, error, partners);
  apply_pairing(state.task.data, partners.of);
  return PairingEvaluated::yes;
}

}  // namespace kinfer::calibrate
