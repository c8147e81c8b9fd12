// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/joint_lag.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/calibrate/diagnosis/motion_regression.hpp"
#include "kinfer/calibrate/diagnosis/thresholds.hpp"
#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/estimate/poses/joint_excitation.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

/// What each joint may differ by at rest: [rad], of a prismatic one [m].
VectorXd rest_limits(const Chain& chain, const PoseSet& data) {
  VectorXd limits(data.joints.rows());
  const auto joints = measure_joint_excitation(chain, data);
  for (Index j = 0; j < limits.size(); ++j)
    limits[j] = joints[static_cast<std::size_t>(j)].is_revolute ? thresholds::settled : thresholds::settled_prismatic;
  return limits;
}

/// Largest difference of commanded and measured joint positions of each row, over what it may be at rest; NaN where a
/// command is missing.
std::vector<double> differences(const PoseSet& data, const VectorXd& limits) {
  std::vector<double> difference;
  for (Index row = 0; row < data.rows(); ++row)
    difference.push_back((data.commanded.col(row) - data.joints.col(row))
                             .cwiseQuotient(limits)
                             .cwiseAbs()
                             .maxCoeff<Eigen::PropagateNaN>());
  return difference;
}

std::vector<int> find_unsettled_rows(const std::vector<double>& difference, double typical) {
  std::vector<int> rows;
  for (std::size_t row = 0; row < difference.size(); ++row)
    if (difference[row] > std::max(1.0, thresholds::unsettled_ratio * typical)) rows.push_back(static_cast<int>(row));
  return rows;
}

/// Median over the rows of the largest difference among the joints with this limit, which are all revolute or all
/// prismatic; nothing where there are none.
std::optional<double> typical_difference(const PoseSet& data, const VectorXd& limits, double limit) {
  std::vector<double> largest;
  for (Index row = 0; row < data.rows(); ++row) {
    double most = -1.0;
    for (Index j = 0; j < limits.size(); ++j)
      if (limits[j] == limit) most = std::max(most, std::abs(data.commanded(j, row) - data.joints(j, row)));
    if (most >= 0.0) largest.push_back(most);
  }
  if (largest.empty()) return std::nullopt;
  return median(largest);
}

void state_difference(const PoseSet& data, const VectorXd& limits, Finding& finding) {
  if (const auto angle = typical_difference(data, limits, thresholds::settled))
    finding.values.set("difference_rad", *angle);
  if (const auto length = typical_difference(data, limits, thresholds::settled_prismatic))
    finding.values.set("difference_m", *length);
}

/// Log likelihood of each row's point errors under Student's t of three dimensions, whose scale is that of most
/// likelihood: a few gross errors decide nothing.
std::vector<double> row_likelihoods(const std::vector<double>& errors, const PoseSet& data) {
  constexpr double freedom = 4.0, dimension = 3.0;
  constexpr int iterations = 50;
  double square = std::max(std::pow(median(errors), 2) / dimension, 1e-18);
  for (int i = 0; i < iterations; ++i) {
    double sum = 0.0;
    for (const double e : errors) sum += (freedom + dimension) * e * e / (freedom + e * e / square);
    square = std::max(sum / (dimension * static_cast<double>(errors.size())), 1e-18);
  }
  std::vector<double> of_row(data.rows(), 0.0);
  for (std::size_t i = 0; i < errors.size(); ++i)
    of_row[data.points[i].row] -= 0.5 * dimension * std::log(square) +
                                  0.5 * (freedom + dimension) * std::log1p(errors[i] * errors[i] / square / freedom);
  return of_row;
}

/// How much better the second of two fits explains the rows: the sum of the rows' log likelihood ratios, and its ratio
/// to its standard deviation (Vuong 1989).
struct PairedComparison {
  double log_ratio = 0.0, z = 0.0;
};

PairedComparison compare_paired(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<double> gain;
  for (std::size_t row = 0; row < first.size(); ++row) gain.push_back(second[row] - first[row]);
  const auto n = static_cast<double>(gain.size());
  const double sd = standard_deviation(gain);
  return {n * mean(gain), sd > 0.0 ? std::sqrt(n) * mean(gain) / sd : 0.0};
}

/// The thinned rows at given joint positions, and their fit.
struct PositionFit {
  PoseSet rows;
  Estimate estimate;
  std::vector<double> errors;  ///< [m] of the points
};

std::optional<PositionFit> fit_positions(const CalibrationTask& task, PoseSet rows) {
  const auto fit = fit_once(task, rows, GeometricParameters{}, {});
  if (!fit) return std::nullopt;
  std::vector<double> errors = point_errors(fit->chain, rows);
  return PositionFit{std::move(rows), *fit, std::move(errors)};
}

/// The rows that have a command and a point, thinned, at the measured positions.
PoseSet rows_with_commands(const PoseSet& data, const std::vector<double>& difference) {
  std::vector<int> rows;
  for (std::size_t row = 0; row < difference.size(); ++row)
    if (std::isfinite(difference[row])) rows.push_back(static_cast<int>(row));
  return thin_pose_set(select(data, rows), thresholds::max_fitted_rows);
}

/// The commanded positions, where the points agree with them rather than with the measured ones.
std::optional<Finding> prefer_commanded(const CalibrationTask& task, const std::vector<double>& difference) {
  const PoseSet rows = rows_with_commands(task.data, difference);
  if (rows.points.size() < thresholds::min_residual_points) return std::nullopt;
  const JointMotions to_command = rows.commanded - rows.joints;
  PoseSet at_commands = rows;
  at_commands.joints = rows.commanded;
  const auto measured = fit_positions(task, rows), commanded = fit_positions(task, std::move(at_commands));
  if (!measured || !commanded) return std::nullopt;
  const PairedComparison gain =
      compare_paired(row_likelihoods(measured->errors, rows), row_likelihoods(commanded->errors, rows));
  if (gain.z < thresholds::min_paired_z || gain.log_ratio < thresholds::min_log_ratio) return std::nullopt;
  Finding finding{.kind = FindingKind::not_settled,
                  .severity = Severity::fault,
                  .values = {{"commanded_error_m", median(commanded->errors)},
                             {"measured_error_m", median(measured->errors)},
                             {"log_evidence_ratio", gain.log_ratio}},
                  .applied = true};
  if (const auto beyond = regress_on_motion(commanded->estimate, commanded->rows, to_command)) {
    finding.values.set("lag", 1.0 + beyond->fraction);
    finding.values.set("lag_sd", beyond->sd);
  }
  return finding;
}

/// Sign of each joint's motion, in a matrix that has only this joint.
std::vector<JointMotions> joint_directions(const JointMotions& motion) {
  std::vector<JointMotions> directions;
  for (Index joint = 0; joint < motion.rows(); ++joint) {
    JointMotions direction = JointMotions::Zero(motion.rows(), motion.cols());
    direction.row(joint) = motion.row(joint).array().sign();
    directions.push_back(std::move(direction));
  }
  return directions;
}

/// From the row before to each row (step −1), or from each row to the next (step 1); NaN where there is none.
JointMotions motion_between_rows(const MatrixXd& joints, Index step) {
  JointMotions motion = JointMotions::Constant(joints.rows(), joints.cols(), std::numeric_limits<double>::quiet_NaN());
  for (Index row = 0; row < joints.cols(); ++row)
    if (const Index other = row + step; other >= 0 && other < joints.cols())
      motion.col(row) = static_cast<double>(step) * (joints.col(other) - joints.col(row));
  return motion;
}

/// Errors that depend on the joint positions alone look alike before and behind a pose, q − q_before like q − q_next:
/// their sum is fitted too. So is what depends on the direction of approach alone: backlash.
std::vector<JointMotions> explained_otherwise(const JointMotions& last, const JointMotions& next) {
  std::vector<JointMotions> others = joint_directions(last);
  others.push_back(last - next);
  return others;
}

}  // namespace

void check_commanded_positions(DiagnosisState& state) {
  PoseSet& data = state.task.data;
  if (data.commanded.size() == 0) return;
  const VectorXd limits = rest_limits(state.task.nominal, data);
  const std::vector<double> difference = differences(data, limits);
  std::vector<double> finite;
  for (const double d : difference)
    if (std::isfinite(d)) finite.push_back(d);
  if (finite.empty() ||
      !((data.commanded - data.joints).cwiseAbs().maxCoeff<Eigen::PropagateNumbers>() >= thresholds::commanded_equal))
    return;
  const double typical = median(finite);
  if (auto finding = prefer_commanded(state.task, difference)) {
    state_difference(data, limits, *finding);
    add_finding(state, *finding);
    for (Index row = 0; row < data.rows(); ++row)
      if (std::isfinite(difference[row])) data.joints.col(row) = data.commanded.col(row);
    return;
  }
  const std::vector<int> rows = find_unsettled_rows(difference, typical);
  if (!rows.empty())
    add_finding(state, {.kind = FindingKind::not_settled, .severity = Severity::warning, .rows = rows});
  else if (typical > 1.0 && data.points.empty()) {
    Finding finding{.kind = FindingKind::not_settled, .severity = Severity::warning};
    state_difference(data, limits, finding);
    add_finding(state, finding);
  }
}

void check_joint_lag(DiagnosisState& state) {
  const PoseSet& data = state.task.data;
  const std::vector<int> row_of = thinned_rows(data, thresholds::max_fitted_rows);
  if (row_of.size() < thresholds::min_lag_rows) return;
  const JointMotions last = motion_between_rows(data.joints, -1)(Eigen::all, row_of),
                     next = motion_between_rows(data.joints, 1)(Eigen::all, row_of);
  const auto fit = fit_positions(state.task, thin_pose_set(data, thresholds::max_fitted_rows));
  if (!fit) return;
  const auto share = regress_on_motion(fit->estimate, fit->rows, last, explained_otherwise(last, next));
  if (!share || std::abs(share->t()) < thresholds::min_lag_t || share->explained < thresholds::min_lag_part) return;
  // residual = fraction · last + symmetric · (last − next)
  const double symmetric = share->others.back(), of_last = share->fraction + symmetric, of_next = -symmetric;
  const bool is_last = std::abs(of_last) >= std::abs(of_next);
  add_finding(state, {.kind = FindingKind::joint_lag,
                      .severity = Severity::warning,
                      .values = {{"motion", std::string(is_last ? "last" : "next")},
                                 {"lag", is_last ? of_last : of_next},
                                 {"lag_sd", share->sd},
                                 {"distance_m", share->distance},
                                 {"error_m", rms(fit->errors)}}});
}

}  // namespace kinfer::calibrate
