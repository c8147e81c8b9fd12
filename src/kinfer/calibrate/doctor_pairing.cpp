#include "kinfer/calibrate/doctor_pairing.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "kinfer/estimate/residuals.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

constexpr int own = 0;     // shift of a row whose readings are its own
constexpr int fewest = 4;  // rows in a run that prove a shift
constexpr int largest_shift = 10;

/// Readings of row i + shift beside the measurements of row i; rows without a partner are left out.
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
struct Judge {
  Chain chain;
  double limit = 0.0;
};

std::optional<Judge> judge_from_all(const CalibrateTask& task, double believable) {
  const auto fit = quick_fit(task.nominal, thinned_points(task.data, 80));
  if (!fit || fit->typical > believable) return std::nullopt;
  constexpr double far_off = 8.0;  // times the median: no Gaussian error is there
  return Judge{fit->chain, std::max(believable, far_off * fit->typical)};
}

std::optional<Judge> judge_from_windows(const CalibrateTask& task, double believable) {
  const auto count = static_cast<int>(task.data.rows());
  const int width = std::clamp(count / 4, 8, 20), furthest = std::min(largest_shift, count / 4);
  std::optional<Judge> best;
  double best_typical = believable;
  for (int begin = 0; begin + width <= count; begin += std::max(1, (count - width) / 3))
    for (int shift = -furthest; shift <= furthest; ++shift) {
      const PoseSet window = shifted_window(task.data, begin, width, shift);
      if (window.rows() < 8 || window.points.size() < 8) continue;
      const auto fit = quick_fit(task.nominal, window);
      if (!fit || fit->typical > best_typical) continue;
      best_typical = fit->typical;
      best = Judge{fit->chain, believable};
    }
  return best;
}

/// error(i, j) [m]: how far the measurement of row i is from the tool at the readings of row j; NaN: not measured.
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

/// Which row's readings belong to the measurement of each row; −1: none of the file.
struct Partners {
  std::vector<int> of;
  std::vector<bool> explained;
};

/// The longest run of unexplained rows that one shift explains; at most one row in five of it may disagree.
struct Run {
  int shift = own, begin = 0, end = 0;  // rows begin .. end − 1
  std::vector<int> rows;                // that are explained
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
    } else if (!now.rows.empty() && 5 * static_cast<std::size_t>(++disagree) > now.rows.size() + 4) {
      close();
    }
  }
  close();
  return best;
}

/// Unexplained rows beside the run whose readings the shift has pushed out of the file.
std::vector<int> lost_rows(const Run& run, const Partners& partners) {
  const int count = static_cast<int>(partners.of.size());
  const int first = run.shift > 0 ? run.end : run.begin + run.shift;
  std::vector<int> lost;
  for (int row = std::max(0, first); row < std::min(count, first + std::abs(run.shift)); ++row)
    if (!partners.explained[row]) lost.push_back(row);
  return lost;
}

void tell_shift(DoctorCase& patient, const Run& run, const std::vector<int>& lost) {
  std::vector<int> rows = run.rows;
  rows.insert(rows.end(), lost.begin(), lost.end());
  std::sort(rows.begin(), rows.end());
  const int by = std::abs(run.shift);
  const bool whole = rows.size() + 2 >= static_cast<std::size_t>(patient.task.data.rows());
  add_finding(
      patient,
      {.kind = "rows_shifted",
       .severity = Severity::fault,
       .rows = rows,
       .sentence = fmt::format("{}the joint readings are shifted by {} row{} against the measurements: those of row i "
                               "belong to the measurement of row i {} {}",
                               whole ? "" : "in " + rows_in_words(rows) + " ", by, by == 1 ? "" : "s",
                               run.shift > 0 ? "-" : "+", by),
       .suggestion = whole ? "pair the rows anew in the file" : "a row is missing or was taken twice where this begins",
       .applied = true});
}

void find_shifts(DoctorCase& patient, const PairErrors& error, double limit, Partners& partners) {
  const int count = static_cast<int>(partners.of.size()), furthest = std::min(largest_shift, count / 4);
  for (;;) {
    Run best;
    for (int shift = -furthest; shift <= furthest; ++shift) {
      if (shift == own) continue;
      const Run run = longest_run(error, partners, limit, shift);
      if (run.rows.size() > best.rows.size()) best = run;
    }
    if (static_cast<int>(best.rows.size()) < fewest) return;
    for (int row = best.begin; row < best.end; ++row)
      partners.of[row] = row + best.shift, partners.explained[row] = true;
    const std::vector<int> lost = lost_rows(best, partners);
    for (const int row : lost) partners.of[row] = -1, partners.explained[row] = true;
    tell_shift(patient, best, lost);
  }
}

/// The only row among `candidates` whose readings explain the measurement of `row`; −1: none, or several.
int only_partner(const PairErrors& error, int row, const std::vector<int>& candidates, double limit) {
  int found = -1;
  for (const int other : candidates) {
    if (other == row || !(error(row, other) <= limit)) continue;
    if (found >= 0) return -1;
    found = other;
  }
  return found;
}

void find_swapped_rows(DoctorCase& patient, const PairErrors& error, double limit, Partners& partners) {
  std::vector<int> open;
  for (int row = 0; row < static_cast<int>(partners.of.size()); ++row)
    if (!partners.explained[row]) open.push_back(row);
  for (const int row : open) {
    if (partners.explained[row]) continue;
    const int other = only_partner(error, row, open, limit);
    if (other < 0 || partners.explained[other] || only_partner(error, other, open, limit) != row) continue;
    partners.explained[row] = partners.explained[other] = true;
    add_finding(patient, {.kind = "rows_swapped",
                          .severity = Severity::warning,
                          .rows = {row, other},
                          .sentence = fmt::format("the measurements of rows {} and {} are swapped", row, other),
                          .suggestion = "exchange them in the file; as they are, calibrate does not believe them"});
  }
}

/// Rows, mostly neighbours, that another place of base and tool explains: something was moved in between.
void find_moved_base(DoctorCase& patient, const Judge& judge, const PairErrors& error, Partners& partners) {
  std::vector<int> open;
  for (int row = 0; row < static_cast<int>(partners.of.size()); ++row)
    if (!partners.explained[row]) open.push_back(row);
  constexpr std::size_t enough = 8;
  if (open.size() < enough || open.back() - open.front() > 2 * static_cast<int>(open.size())) return;
  PoseSet block = select(patient.task.data, open);
  block.orientations.clear();
  const auto fit = quick_fit(patient.task.nominal, block);
  if (!fit || fit->typical > judge.limit) return;
  std::vector<double> moved;
  for (const int row : open) moved.push_back(error(row, row));
  for (const int row : open) partners.explained[row] = true;
  add_finding(patient,
              {.kind = "base_moved",
               .severity = Severity::fault,
               .rows = open,
               .sentence = fmt::format("in {} the tool is {:.1f} mm elsewhere, and one other place of base and tool "
                                       "explains all of them: the robot, the instrument or the tool was moved",
                                       rows_in_words(open), 1e3 * median(moved)),
               .suggestion = "give these rows a setup of their own in a column called setup"});
}

void re_pair(PoseSet& data, const std::vector<int>& partner) {
  const PoseSet before = data;
  for (int row = 0; row < data.rows(); ++row) {
    if (partner[row] == row || partner[row] < 0) continue;
    data.joints.col(row) = before.joints.col(partner[row]);
    if (data.commanded.size() > 0) data.commanded.col(row) = before.commanded.col(partner[row]);
    if (data.torques.size() > 0) data.torques.col(row) = before.torques.col(partner[row]);
  }
  const auto lost = [&](const auto& measurement) { return partner[measurement.row] < 0; };
  std::erase_if(data.points, lost);
  std::erase_if(data.orientations, lost);
}

}  // namespace

PairingJudged check_pairing(DoctorCase& patient) {
  const CalibrateTask& task = patient.task;
  constexpr int too_few = 8;
  if (task.data.points.empty() || task.data.rows() < too_few) return PairingJudged::no;
  const double believable = believable_error(task);
  auto judge = judge_from_all(task, believable);
  if (!judge) judge = judge_from_windows(task, believable);
  if (!judge) return PairingJudged::no;
  const PairErrors error(judge->chain, task.data);
  Partners partners;
  for (int row = 0; row < task.data.rows(); ++row) {
    partners.of.push_back(row);
    partners.explained.push_back(!error.measured(row) || error(row, row) <= judge->limit);
  }
  const std::size_t findings_before = patient.findings.size();
  find_shifts(patient, error, judge->limit, partners);
  const auto explained = std::count(partners.explained.begin(), partners.explained.end(), true);
  if (explained < (2 * task.data.rows()) / 5) {  // a run in which the wrong joint rested fits by chance
    patient.findings.resize(findings_before);
    return PairingJudged::no;
  }
  find_swapped_rows(patient, error, judge->limit, partners);
  find_moved_base(patient, *judge, error, partners);
  re_pair(patient.task.data, partners.of);
  return PairingJudged::yes;
}

}  // namespace kinfer
