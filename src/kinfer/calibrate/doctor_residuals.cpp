#include "kinfer/calibrate/doctor_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "kinfer/calibrate/single_fit.hpp"
#include "kinfer/estimate/residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/normal_equations.hpp"

namespace kinfer {
namespace {

constexpr std::size_t rows_judged = 400;  // more tell no more, and cost time before each calibration

/// The task with fewer rows, positions only.
CalibrateTask thinned(const CalibrateTask& task) {
  CalibrateTask thin = task;
  thin.data = thinned_points(task.data, rows_judged);
  return thin;
}

std::vector<double> believed_errors(const Estimate& estimate, const PoseSet& data) {
  std::set<int> wrong;
  for (const Outlier& outlier : estimate.outliers) wrong.insert(outlier.row);
  const std::vector<double> all = point_errors(estimate.chain, data);
  std::vector<double> errors;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!wrong.contains(data.points[i].row)) errors.push_back(all[i]);
  return errors;
}

std::optional<double> typical_after_fit(const CalibrateTask& task) {
  const auto fit = fit_once(task, task.data, AutoParameters{}, {});
  if (!fit) return std::nullopt;
  std::vector<double> errors = believed_errors(*fit, task.data);
  return errors.empty() ? std::nullopt : std::optional(median(std::move(errors)));
}

/// Largest difference of commanded and read-back readings of each row; NaN where a command is missing.
std::vector<double> differences(const PoseSet& data) {
  std::vector<double> difference;
  for (Eigen::Index row = 0; row < data.rows(); ++row)
    difference.push_back((data.commanded.col(row) - data.joints.col(row)).cwiseAbs().maxCoeff());
  return difference;
}

std::vector<int> moving_rows(const std::vector<double>& difference, double typical) {
  constexpr double settled = 0.05 * degree, by_far = 10.0;
  std::vector<int> rows;
  for (std::size_t row = 0; row < difference.size(); ++row)
    if (difference[row] > std::max(settled, by_far * typical)) rows.push_back(static_cast<int>(row));
  return rows;
}

/// Residuals of the believed points, and how a base that moves rigidly with `phase` (one a row) would show in them:
/// residual = (shift + turn × (point − centre)) · phase.
class RigidMotion {
 public:
  RigidMotion(const Chain& chain, const PoseSet& data, const std::set<int>& wrong) {
    const EvaluatedPoses at = evaluate_poses(chain, {}, data, Derivative::no);
    for (const PointMeasurement& point : data.points) {
      if (point.target >= 0 || wrong.contains(point.row)) continue;
      points_.push_back({point.row, at.pose[point.row].position, point.position - at.pose[point.row].position});
      centre_ += points_.back().place;
    }
    if (!points_.empty()) centre_ /= static_cast<double>(points_.size());
  }

  struct Found {
    double f = 0.0;        ///< squares that the six unknowns explain, each, over those that are left, each
    double moved = 0.0;    ///< [m] rms over the points, for phase = 1
    double scatter = 0.0;  ///< [m] per axis, of what is left
  };
  /// Least squares over the six coordinates of the motion and a constant one, which the fit's own base absorbs.
  template <class Phase>
  Found explain(Phase phase) const {
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
    const auto constant = damped_by_cholesky(normal_equations(a.leftCols(6), -b), 0.0);
    const auto x = damped_by_cholesky(normal_equations(a, -b), 0.0);
    if (!constant || !x) return {};
    const double freedom = std::max(1.0, 3.0 * static_cast<double>(n) - 12.0);
    const double left = (b - a * *x).squaredNorm() / freedom;
    Found found;
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

void check_drift(DoctorCase& patient, const Chain& chain, const PoseSet& data, const std::vector<int>& row_of,
                 const std::set<int>& wrong) {
  const RigidMotion motion(chain, data, wrong);
  const auto count = static_cast<int>(data.rows());
  constexpr int too_few = 20;
  if (count < too_few || data.setups.size() > 1) return;
  const auto linear = motion.explain([count](int row) { return (row + 0.5) / count - 0.5; });
  RigidMotion::Found step;
  int step_at = 0;
  for (int at = count / 10; at <= count - count / 10; at += std::max(1, count / 50)) {
    const auto found = motion.explain([at](int row) { return row < at ? -0.5 : 0.5; });
    if (found.f > step.f) step = found, step_at = at;
  }
  const bool steps = step.f > 1.5 * linear.f;
  const RigidMotion::Found& found = steps ? step : linear;
  // Poses are rarely measured in random order, so what the model lacks follows the rows too. It does so at any pace;
  // a drift shows in the slow pace only.
  std::vector<double> other_paces;
  for (int waves = 1; waves <= 6; ++waves)
    other_paces.push_back(
        motion.explain([=](int row) { return std::cos(2 * std::numbers::pi * waves * (row + 0.5) / count); }).f);
  constexpr double never_by_chance = 10.0;  // F beyond 6.4 is chi-squared of six beyond its one-in-a-million mark
  if (found.f < never_by_chance * std::max(1.0, median(other_paces))) return;
  if (found.moved < 1.5 * found.scatter) return;  // significant, but smaller than what is not known anyway
  const double moved = found.moved;
  add_finding(patient,
              {.kind = steps ? "base_moved" : "base_drifts",
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

/// Points of the rows that were not fitted and that the fit puts further off than noise explains.
std::vector<Outlier> wrong_elsewhere(const Estimate& fit, const CalibrateTask& task, const std::vector<int>& fitted) {
  constexpr double false_alarms = 1e-3;  // in a whole data set, as in the fit
  constexpr double unseen = 1.25;        // a fit predicts what it has not seen less well than its noise says
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

void check_commanded(DoctorCase& patient) {
  PoseSet& data = patient.task.data;
  if (data.commanded.size() == 0) return;
  std::vector<double> difference = differences(data), finite;
  for (const double d : difference)
    if (std::isfinite(d)) finite.push_back(d);
  constexpr double same = 1e-6;  // [rad], [m]
  if (finite.empty() || median(finite) < same) return;
  const double typical = median(finite);
  const bool complete = finite.size() == difference.size();
  CalibrateTask as_read = thinned(patient.task), as_told = as_read;
  as_told.data.joints = as_told.data.commanded;
  const auto read = data.points.empty() ? std::nullopt : typical_after_fit(as_read);
  const auto told = data.points.empty() || !complete ? std::nullopt : typical_after_fit(as_told);
  constexpr double clearly = 0.8;
  if (read && told && *told < clearly * *read) {
    add_finding(patient,
                {.kind = "not_settled",
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
  const std::vector<int> rows = moving_rows(difference, typical);
  constexpr double settled = 0.05 * degree;
  if (!rows.empty())
    add_finding(patient,
                {.kind = "not_settled",
                 .severity = Severity::warning,
                 .rows = rows,
                 .sentence = fmt::format("in {} commanded and read-back joints differ far more than elsewhere: "
                                         "the arm had not come to rest",
                                         rows_in_words(rows)),
                 .suggestion = "measure these rows again or leave them out"});
  else if (typical > settled && !read)
    add_finding(patient, {.kind = "not_settled",
                          .severity = Severity::warning,
                          .sentence = fmt::format("commanded and read-back joints differ by {:.3f} deg typically: was "
                                                  "the arm still moving?",
                                                  typical / degree),
                          .suggestion = "read back after the arm has come to rest"});
}

/// Rows of which another finding has told already what is wrong.
std::set<int> explained_rows(const DoctorCase& patient) {
  std::set<int> rows;
  for (const Finding& finding : patient.findings)
    if (!finding.applied && finding.severity != Severity::note) rows.insert(finding.rows.begin(), finding.rows.end());
  return rows;
}

/// Of the thinned rows in the whole set, ascending.
std::vector<int> rows_in_all(const PoseSet& thin, const PoseSet& all) {
  std::vector<int> row_of(thin.rows());
  for (std::size_t i = 0, row = 0; i < row_of.size(); ++i) {
    while (!thin.line.empty() && row < all.line.size() && all.line[row] != thin.line[i]) ++row;
    row_of[i] = thin.line.empty() ? static_cast<int>(i) : static_cast<int>(row);
  }
  return row_of;
}

void tell_gross_outliers(DoctorCase& patient, std::vector<Outlier> wrong) {
  const std::set<int> told = explained_rows(patient);
  std::erase_if(wrong, [&](const Outlier& outlier) { return told.contains(outlier.row); });
  std::sort(wrong.begin(), wrong.end(), [](const Outlier& a, const Outlier& b) { return a.row < b.row; });
  std::set<int> rows;
  for (const Outlier& outlier : wrong) rows.insert(outlier.row);
  if (rows.empty() || 4 * static_cast<Eigen::Index>(rows.size()) > patient.task.data.rows()) return;
  const std::vector<int> list(rows.begin(), rows.end());
  add_finding(patient, {.kind = "gross_outliers",
                        .severity = Severity::warning,
                        .rows = list,
                        .sentence = fmt::format("{} {} where no noise explains it: {}{}", rows_in_words(list),
                                                list.size() == 1 ? "lies" : "lie",
                                                list.size() == 1 ? "" : "in the first ", wrong.front().reason),
                        .suggestion = "calibrate does not believe such rows; look at them"});
}

void check_residuals(DoctorCase& patient) {
  constexpr std::size_t too_few = 12;  // rows; base, tool and joints take three of each four equations
  if (patient.task.data.points.size() < too_few) return;
  const CalibrateTask thin = thinned(patient.task);
  const auto fit = fit_once(thin, thin.data, AutoParameters{}, {});
  if (!fit) return;
  const std::vector<int> row_of = rows_in_all(thin.data, patient.task.data);
  const std::set<int> told = explained_rows(patient);
  std::vector<Outlier> gross = wrong_elsewhere(*fit, patient.task, row_of);
  std::set<int> wrong;  // of the thinned rows
  for (std::size_t i = 0; i < row_of.size(); ++i)
    if (told.contains(row_of[i])) wrong.insert(static_cast<int>(i));
  for (Outlier outlier : fit->outliers) {
    wrong.insert(outlier.row);
    outlier.row = row_of[outlier.row];
    gross.push_back(outlier);
  }
  check_drift(patient, fit->chain, thin.data, row_of, wrong);
  tell_gross_outliers(patient, gross);
}

}  // namespace kinfer
