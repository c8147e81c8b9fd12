// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/fit_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "kinfer/calibrate/diagnosis/thresholds.hpp"
#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/normal_equations.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

/// The task with fewer rows, without orientations.
CalibrationTask thin_task(const CalibrationTask& task) {
  CalibrationTask thin = task;
  thin.data = thin_pose_set(task.data, thresholds::max_fitted_rows);
  return thin;
}

/// Residuals of the inlier points, regressed on a rigid motion of the base with amplitude `phase` (one per row):
/// residual = (translation + rotation × (point − centre)) · phase.
class RigidMotionRegression {
 public:
  RigidMotionRegression(const Chain& chain, const PoseSet& data, const std::set<int>& wrong) {
    const EvaluatedPoses at = evaluate_poses(chain, {}, data, Derivative::no);
    for (const PointMeasurement& point : data.points) {
      if (point.target >= 0 || wrong.contains(point.row)) continue;
      points_.push_back({point.row, at.pose[point.row].position, point.position - at.pose[point.row].position});
      centre_ += points_.back().place;
    }
    if (!points_.empty()) centre_ /= static_cast<double>(points_.size());
  }

  struct Regression {
    double f = 0.0;        ///< F statistic: explained variance per unknown over residual variance
    double moved = 0.0;    ///< [m] rms over the points, for phase = 1
    double scatter = 0.0;  ///< [m] sd per axis of the remaining residuals
  };
  /// Least squares over the six coordinates of the motion and of a constant offset, which the fitted base absorbs.
  template <class Phase>
  Regression regress(Phase phase) const {
    const auto n = static_cast<Eigen::Index>(points_.size());
    MatrixXd a(3 * n, 12);
    VectorXd b(3 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Point& p = points_[i];
      Eigen::Matrix<double, 3, 6> rigid;
      rigid << Mat3::Identity(), -skew(p.place - centre_);
      a.middleRows<3>(3 * i) << rigid, phase(p.row) * rigid;
      b.segment<3>(3 * i) = p.residual;
    }
    const auto constant = solve_damped_by_cholesky(normal_equations(a.leftCols(6), -b), 0.0);
    const auto x = solve_damped_by_cholesky(normal_equations(a, -b), 0.0);
    if (!constant || !x) return {};
    const double freedom = std::max(1.0, 3.0 * static_cast<double>(n) - 12.0);
    const double left = (b - a * *x).squaredNorm() / freedom;
    Regression found;
    found.scatter = std::sqrt(left);
    found.f = ((b - a.leftCols(6) * *constant).squaredNorm() / freedom - left) * freedom / 6.0 / std::max(left, 1e-300);
    for (const Point& p : points_)
      found.moved += (x->segment<3>(6) - skew(p.place - centre_) * x->tail<3>()).squaredNorm();
    found.moved = std::sqrt(found.moved / static_cast<double>(n));
    return found;
  }

 private:
  struct Point {
    int row;
    Vec3 place, residual;  // [m] in the world
  };
  std::vector<Point> points_;
  Vec3 centre_ = Vec3::Zero();
};

void check_drift(DiagnosisState& state, const Chain& chain, const PoseSet& data, const std::vector<int>& row_of,
                 const std::set<int>& wrong) {
  const RigidMotionRegression motion(chain, data, wrong);
  const auto count = static_cast<int>(data.rows());
  if (count < thresholds::min_drift_rows || data.setups.size() > 1) return;
  const auto linear = motion.regress([count](int row) { return (row + 0.5) / count - 0.5; });
  RigidMotionRegression::Regression step;
  int step_at = 0;
  for (int at = count / 10; at <= count - count / 10; at += std::max(1, count / 50)) {
    const auto found = motion.regress([at](int row) { return row < at ? -0.5 : 0.5; });
    if (found.f > step.f) step = found, step_at = at;
  }
  const bool steps = step.f > thresholds::step_over_drift * linear.f;
  const RigidMotionRegression::Regression& found = steps ? step : linear;
  // Poses are rarely measured in random order, so model errors correlate with the row index too. They do so at any
  // frequency; a drift does so at the lowest only.
  std::vector<double> other_frequencies;
  for (int waves = 1; waves <= 6; ++waves)
    other_frequencies.push_back(
        motion.regress([=](int row) { return std::cos(2 * std::numbers::pi * waves * (row + 0.5) / count); }).f);
  if (found.f < thresholds::min_f_statistic * std::max(1.0, median(other_frequencies))) return;
  if (found.moved < thresholds::min_motion_ratio * found.scatter)
    return;  // significant, but smaller than the unmodelled error
  FactValues values{{"distance_m", found.moved}};
  if (steps) values.set("from_row", row_of[step_at]);
  add_finding(state, {.kind = steps ? FindingKind::base_moved : FindingKind::base_drifts,
                      .severity = Severity::warning,
                      .values = values});
}

/// Points of rows that were not fitted whose errors exceed the noise.
std::vector<Outlier> find_unfitted_outliers(const Estimate& fit, const CalibrationTask& task,
                                            const std::vector<int>& fitted) {
  const auto count = std::max<double>(1.0, static_cast<double>(task.data.points.size()));
  const double limit =
      thresholds::unfitted_ratio * std::sqrt(chi_squared_quantile(1.0 - thresholds::false_alarms / count, 3));
  const std::vector<double> errors = point_errors(fit.chain, task.data);
  std::vector<Outlier> wrong;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const PointMeasurement& point = task.data.points[i];
    const double sd = std::max(fit.sigma, point.sd ? point.sd->maxCoeff() : 0.0);
    if (errors[i] <= limit * sd || std::binary_search(fitted.begin(), fitted.end(), point.row)) continue;
    wrong.push_back({.row = point.row,
                     .reasons = {{kind_of<PointMeasurement>, errors[i], errors[i] / sd}},
                     .sigmas = errors[i] / sd});
  }
  return wrong;
}

/// What the outlier of the first row is off by, for the sentence.
FactValues reasons_of(const Outlier& outlier) {
  std::vector<std::string> kinds;
  std::vector<double> residuals, sigmas;
  for (const OutlierReason& reason : outlier.reasons) {
    kinds.emplace_back(name(reason.kind));
    residuals.push_back(reason.residual), sigmas.push_back(reason.sigmas);
  }
  return {{"kinds", kinds}, {"residuals", residuals}, {"sigmas", sigmas}};
}

/// Of one finding: none where no row is left.
std::optional<Finding> left_by(Finding finding, const std::vector<Outlier>& outliers) {
  const std::vector<int> named = std::move(finding.rows);
  finding.rows.clear();
  for (const Outlier& outlier : outliers) {
    if (!std::ranges::binary_search(named, outlier.row)) continue;
    if (finding.rows.empty()) finding.values = reasons_of(outlier);
    finding.rows.push_back(outlier.row);
  }
  return finding.rows.empty() ? std::nullopt : std::optional{finding};
}

}  // namespace

/// Rows that another finding already explains.
std::set<int> collect_explained_rows(const DiagnosisState& state) {
  std::set<int> rows;
  for (const Finding& finding : state.findings)
    if (!finding.applied && finding.severity != Severity::note) rows.insert(finding.rows.begin(), finding.rows.end());
  return rows;
}

void report_gross_outliers(DiagnosisState& state, std::vector<Outlier> wrong) {
  const std::set<int> explained = collect_explained_rows(state);
  std::erase_if(wrong, [&](const Outlier& outlier) { return explained.contains(outlier.row); });
  std::sort(wrong.begin(), wrong.end(), [](const Outlier& a, const Outlier& b) { return a.row < b.row; });
  std::set<int> rows;
  for (const Outlier& outlier : wrong) rows.insert(outlier.row);
  if (rows.empty() || thresholds::max_outlier_part * static_cast<Eigen::Index>(rows.size()) > state.task.data.rows())
    return;
  const std::vector<int> list(rows.begin(), rows.end());
  add_finding(state, {.kind = FindingKind::gross_outliers,
                      .severity = Severity::warning,
                      .rows = list,
                      .values = reasons_of(wrong.front())});
}

void check_residuals(DiagnosisState& state) {
  if (state.task.data.points.size() < thresholds::min_residual_points) return;
  const CalibrationTask thin = thin_task(state.task);
  const auto fit = fit_once(thin, thin.data, GeometricParameters{}, {});
  if (!fit) return;
  const std::vector<int> row_of = thinned_rows(state.task.data, thresholds::max_fitted_rows);
  const std::set<int> explained = collect_explained_rows(state);
  std::vector<Outlier> gross = find_unfitted_outliers(*fit, state.task, row_of);
  std::set<int> wrong;  // of the thinned rows
  for (std::size_t i = 0; i < row_of.size(); ++i)
    if (explained.contains(row_of[i])) wrong.insert(static_cast<int>(i));
  for (Outlier outlier : fit->outliers) {
    wrong.insert(outlier.row);
    outlier.row = row_of[outlier.row];
    gross.push_back(outlier);
  }
  check_drift(state, fit->chain, thin.data, row_of, wrong);
  report_gross_outliers(state, gross);
}

std::vector<Finding> findings_left_by(std::vector<Finding> findings, std::vector<Outlier> outliers) {
  std::ranges::sort(outliers, {}, &Outlier::row);
  std::vector<Finding> left;
  for (Finding& finding : findings) {
    if (finding.kind != FindingKind::gross_outliers)
      left.push_back(std::move(finding));
    else if (auto unexplained = left_by(std::move(finding), outliers))
      left.push_back(*std::move(unexplained));
  }
  return left;
}

}  // namespace kinfer::calibrate
