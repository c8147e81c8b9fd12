// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/fit_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/normal_equations.hpp"

namespace kinfer::calibrate {
namespace {

constexpr std::size_t max_rows = 400;  // more add no information, and cost time before each calibration

/// The task with fewer rows, without orientations.
CalibrationTask thin_task(const CalibrationTask& task) {
  CalibrationTask thin = task;
  thin.data = thin_pose_set(task.data, max_rows);
  return thin;
}

std::vector<double> inlier_errors(const Estimate& estimate, const PoseSet& data) {
  std::set<int> wrong;
  for (const Outlier& outlier : estimate.outliers) wrong.insert(outlier.row);
  const std::vector<double> all = point_errors(estimate.chain, data);
  std::vector<double> errors;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!wrong.contains(data.points[i].row)) errors.push_back(all[i]);
  return errors;
}

std::optional<double> median_error_after_fit(const CalibrationTask& task) {
  const auto fit = fit_once(task, task.data, GeometricParameters{}, {});
  if (!fit) return std::nullopt;
  std::vector<double> errors = inlier_errors(*fit, task.data);
  return errors.empty() ? std::nullopt : std::optional(median(std::move(errors)));
}

/// Largest difference of commanded and measured joint positions of each row; NaN where a command is missing.
std::vector<double> differences(const PoseSet& data) {
  std::vector<double> difference;
  for (Eigen::Index row = 0; row < data.rows(); ++row)
    difference.push_back((data.commanded.col(row) - data.joints.col(row)).cwiseAbs().maxCoeff());
  return difference;
}

std::vector<int> find_unsettled_rows(const std::vector<double>& difference, double typical) {
  constexpr double settled = 0.05 * degree, by_far = 10.0;
  std::vector<int> rows;
  for (std::size_t row = 0; row < difference.size(); ++row)
    if (difference[row] > std::max(settled, by_far * typical)) rows.push_back(static_cast<int>(row));
  return rows;
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
  constexpr int too_few = 20;
  if (count < too_few || data.setups.size() > 1) return;
  const auto linear = motion.regress([count](int row) { return (row + 0.5) / count - 0.5; });
  RigidMotionRegression::Regression step;
  int step_at = 0;
  for (int at = count / 10; at <= count - count / 10; at += std::max(1, count / 50)) {
    const auto found = motion.regress([at](int row) { return row < at ? -0.5 : 0.5; });
    if (found.f > step.f) step = found, step_at = at;
  }
  const bool steps = step.f > 1.5 * linear.f;
  const RigidMotionRegression::Regression& found = steps ? step : linear;
  // Poses are rarely measured in random order, so model errors correlate with the row index too. They do so at any
  // frequency; a drift does so at the lowest only.
  std::vector<double> other_frequencies;
  for (int waves = 1; waves <= 6; ++waves)
    other_frequencies.push_back(
        motion.regress([=](int row) { return std::cos(2 * std::numbers::pi * waves * (row + 0.5) / count); }).f);
  constexpr double min_f_statistic = 10.0;  // F = 6.4 is chi-squared of six at its one-in-a-million quantile
  if (found.f < min_f_statistic * std::max(1.0, median(other_frequencies))) return;
  if (found.moved < 1.5 * found.scatter) return;  // significant, but smaller than the unmodelled error
  const double moved = found.moved;
  add_finding(state,
              {.kind = steps ? FindingKind::base_moved : FindingKind::base_drifts,
               .severity = Severity::warning,
               .sentence = steps ? fmt::format("from row {} on, the tool is seen {:.3f} mm elsewhere: the robot, the "
                                               "instrument or the tool was moved a little",
                                               row_of[step_at], 1e3 * moved)
                                 : fmt::format("the tool is seen to drift by {:.3f} mm from the first row to the last: "
                                               "the base or the instrument moves, or the robot warms up",
                                               1e3 * moved),
               .suggestion = steps ? fmt::format("give the rows from {} on a setup of their own", row_of[step_at])
                                   : "warm up first, measure in random order, and measure the base again in between"});
}

/// Points of rows that were not fitted whose errors exceed the noise.
std::vector<Outlier> find_unfitted_outliers(const Estimate& fit, const CalibrationTask& task,
                                            const std::vector<int>& fitted) {
  constexpr double false_alarms = 1e-3;  // per data set, as in the fit
  constexpr double unseen = 1.25;        // errors of unfitted rows exceed the noise level of the fit
  const auto count = std::max<double>(1.0, static_cast<double>(task.data.points.size()));
  const double limit = unseen * std::sqrt(chi_squared_quantile(1.0 - false_alarms / count, 3));
  const std::vector<double> errors = point_errors(fit.chain, task.data);
  std::vector<Outlier> wrong;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const PointMeasurement& point = task.data.points[i];
    const double sd = std::max(fit.sigma, point.sd ? point.sd->maxCoeff() : 0.0);
    if (errors[i] <= limit * sd || std::binary_search(fitted.begin(), fitted.end(), point.row)) continue;
    wrong.push_back({point.row, 0,
                     fmt::format("the point lies {:.3f} mm from where the model has it ({:.0f} sigma)", 1e3 * errors[i],
                                 errors[i] / sd),
                     errors[i] / sd});
  }
  return wrong;
}

}  // namespace

void check_commanded_positions(DiagnosisState& state) {
  PoseSet& data = state.task.data;
  if (data.commanded.size() == 0) return;
  std::vector<double> difference = differences(data), finite;
  for (const double d : difference)
    if (std::isfinite(d)) finite.push_back(d);
  constexpr double same = 1e-6;  // [rad], [m]
  if (finite.empty() || median(finite) < same) return;
  const double typical = median(finite);
  const bool complete = finite.size() == difference.size();
  CalibrationTask measured_task = thin_task(state.task), commanded_task = measured_task;
  commanded_task.data.joints = commanded_task.data.commanded;
  const auto read = data.points.empty() ? std::nullopt : median_error_after_fit(measured_task);
  const auto told = data.points.empty() || !complete ? std::nullopt : median_error_after_fit(commanded_task);
  constexpr double clearly = 0.8;
  if (read && told && *told < clearly * *read) {
    add_finding(state,
                {.kind = FindingKind::not_settled,
                 .severity = Severity::fault,
                 .sentence = fmt::format("the read-back joints were taken while the arm still moved: they differ from "
                                         "the commanded ones by {:.3f} deg typically, and the commanded ones explain "
                                         "the points to {:.3f} mm instead of {:.3f} mm",
                                         typical / degree, 1e3 * *told, 1e3 * *read),
                 .suggestion = "use the commanded joints, or read back after the arm has come to rest",
                 .applied = true});
    data.joints = data.commanded;
    return;
  }
  const std::vector<int> rows = find_unsettled_rows(difference, typical);
  constexpr double settled = 0.05 * degree;
  if (!rows.empty())
    add_finding(state, {.kind = FindingKind::not_settled,
                        .severity = Severity::warning,
                        .rows = rows,
                        .sentence = fmt::format("in {} commanded and read-back joints differ far more than elsewhere: "
                                                "the arm had not come to rest",
                                                describe_rows(rows)),
                        .suggestion = "measure these rows again or leave them out"});
  else if (typical > settled && !read)
    add_finding(state, {.kind = FindingKind::not_settled,
                        .severity = Severity::warning,
                        .sentence = fmt::format("commanded and read-back joints differ by {:.3f} deg typically: was "
                                                "the arm still moving?",
                                                typical / degree),
                        .suggestion = "read back after the arm has come to rest"});
}

/// Rows that another finding already explains.
std::set<int> collect_explained_rows(const DiagnosisState& state) {
  std::set<int> rows;
  for (const Finding& finding : state.findings)
    if (!finding.applied && finding.severity != Severity::note) rows.insert(finding.rows.begin(), finding.rows.end());
  return rows;
}

/// Index of each thinned row in the whole set, ascending.
std::vector<int> rows_in_all(const PoseSet& thin, const PoseSet& all) {
  std::vector<int> row_of(thin.rows());
  for (std::size_t i = 0, row = 0; i < row_of.size(); ++i) {
    while (!thin.line.empty() && row < all.line.size() && all.line[row] != thin.line[i]) ++row;
    row_of[i] = thin.line.empty() ? static_cast<int>(i) : static_cast<int>(row);
  }
  return row_of;
}

void report_gross_outliers(DiagnosisState& state, std::vector<Outlier> wrong) {
  const std::set<int> told = collect_explained_rows(state);
  std::erase_if(wrong, [&](const Outlier& outlier) { return told.contains(outlier.row); });
  std::sort(wrong.begin(), wrong.end(), [](const Outlier& a, const Outlier& b) { return a.row < b.row; });
  std::set<int> rows;
  for (const Outlier& outlier : wrong) rows.insert(outlier.row);
  if (rows.empty() || 4 * static_cast<Eigen::Index>(rows.size()) > state.task.data.rows()) return;
  const std::vector<int> list(rows.begin(), rows.end());
  add_finding(state, {.kind = FindingKind::gross_outliers,
                      .severity = Severity::warning,
                      .rows = list,
                      .sentence = fmt::format("{} {} where no noise explains it: {}{}", describe_rows(list),
                                              list.size() == 1 ? "lies" : "lie",
                                              list.size() == 1 ? "" : "in the first ", wrong.front().reason),
                      .suggestion = "calibrate does not believe such rows; look at them"});
}

void check_residuals(DiagnosisState& state) {
  constexpr std::size_t too_few = 12;  // rows; base, tool and joints then use up three of four equations
  if (state.task.data.points.size() < too_few) return;
  const CalibrationTask thin = thin_task(state.task);
  const auto fit = fit_once(thin, thin.data, GeometricParameters{}, {});
  if (!fit) return;
  const std::vector<int> row_of = rows_in_all(thin.data, state.task.data);
  const std::set<int> told = collect_explained_rows(state);
  std::vector<Outlier> gross = find_unfitted_outliers(*fit, state.task, row_of);
  std::set<int> wrong;  // of the thinned rows
  for (std::size_t i = 0; i < row_of.size(); ++i)
    if (told.contains(row_of[i])) wrong.insert(static_cast<int>(i));
  for (Outlier outlier : fit->outliers) {
    wrong.insert(outlier.row);
    outlier.row = row_of[outlier.row];
    gross.push_back(outlier);
  }
  check_drift(state, fit->chain, thin.data, row_of, wrong);
  report_gross_outliers(state, gross);
}

}  // namespace kinfer::calibrate
