// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/joint_positions.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "kinfer/calibrate/diagnosis/thresholds.hpp"
#include "kinfer/estimate/poses/joint_excitation.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/measurement/copies.hpp"

namespace kinfer::calibrate {
namespace {

void check_limits(DiagnosisState& state) {
  const Chain& chain = state.task.nominal;
  const MatrixXd& joints = state.task.data.joints;
  const std::vector<int> moving = active_joints(chain);
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const Joint& joint = chain.joints[moving[k]];
    const double slack = rotates(joint.type) ? thresholds::limit_slack_angle : thresholds::limit_slack_length;
    std::vector<int> rows;
    for (Eigen::Index row = 0; row < joints.cols(); ++row) {
      const double q = joints(static_cast<Eigen::Index>(k), row);
      if (q < joint.lower - slack || q > joint.upper + slack) rows.push_back(static_cast<int>(row));
    }
    if (rows.empty()) continue;
    add_finding(state, {.kind = FindingKind::outside_limits,
                        .severity = Severity::note,
                        .rows = rows,
                        .values = {{"joint", joint.name}}});
  }
}

/// The measured values of each row as a flat list, to compare rows.
std::vector<std::vector<double>> measured_values(const PoseSet& data) {
  std::vector<std::vector<double>> numbers(data.rows());
  for (const PointMeasurement& m : data.points)
    numbers[m.row].insert(numbers[m.row].end(), {1.0 * m.target, m.position.x(), m.position.y(), m.position.z()});
  for (const DistanceMeasurement& m : data.distances)
    numbers[m.row].insert(numbers[m.row].end(), {1.0 * m.anchor, m.distance});
  return numbers;
}

/// Groups of two or more rows with the same key; rows with an empty key are ignored.
std::map<std::vector<double>, std::vector<int>> group_equal_rows(const std::vector<std::vector<double>>& keys) {
  std::map<std::vector<double>, std::vector<int>> places;
  for (std::size_t row = 0; row < keys.size(); ++row)
    if (!keys[row].empty()) places[keys[row]].push_back(static_cast<int>(row));
  std::erase_if(places, [](const auto& entry) { return entry.second.size() < 2; });
  return places;
}

/// Distance of the second target from the first in each row that has both.
struct TargetPair {
  std::vector<int> rows;
  std::vector<double> distance;  // [m]
};

std::map<std::pair<int, int>, TargetPair> target_pairs(const PoseSet& data) {
  std::map<int, std::vector<const PointMeasurement*>> of_row;
  for (const PointMeasurement& point : data.points) of_row[point.row].push_back(&point);
  std::map<std::pair<int, int>, TargetPair> pairs;
  for (const auto& [row, points] : of_row)
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t j = i + 1; j < points.size(); ++j) {
        TargetPair& pair = pairs[std::minmax(points[i]->target, points[j]->target)];
        pair.rows.push_back(row);
        pair.distance.push_back((points[i]->position - points[j]->position).norm());
      }
  return pairs;
}

/// Empty: the tool point.
std::string target_name(const PoseSet& data, int target) {
  return target < 0 ? "" : data.targets[target];
}

void check_target_pair(DiagnosisState& state, const std::vector<std::string>& targets, const TargetPair& pair) {
  const double typical = median(pair.distance);
  const double sd = robust_sd(pair.distance);
  const double sigma = state.task.instrument ? state.task.instrument->sigma : 0.0;
  std::vector<int> rows;
  for (std::size_t i = 0; i < pair.distance.size(); ++i)
    if (std::abs(pair.distance[i] - typical) > thresholds::rigidity_sigmas * std::max({sd, 2.0 * sigma, 1e-6}))
      rows.push_back(pair.rows[i]);
  if (!rows.empty())
    add_finding(state, {.kind = FindingKind::not_rigid,
                        .severity = Severity::warning,
                        .rows = rows,
                        .values = {{"targets", targets}, {"distance_m", typical}}});
  else if (sigma > 0.0 && sd > thresholds::rigidity_sigmas * sigma)
    add_finding(state, {.kind = FindingKind::not_rigid,
                        .severity = Severity::warning,
                        .values = {{"targets", targets}, {"sd_m", sd}, {"sigma_m", sigma}}});
}

}  // namespace

void check_joint_positions(DiagnosisState& state) {
  for (const JointExcitation& j : measure_joint_excitation(state.task.nominal, state.task.data)) {
    if (j.sd < (j.is_revolute ? thresholds::min_excitation_angle : thresholds::min_excitation_length))
      add_finding(
          state,
          {.kind = FindingKind::joint_hardly_moves, .severity = Severity::warning, .values = {{"joint", j.name}}});
  }
  check_limits(state);
}

void check_duplicate_rows(DiagnosisState& state) {
  const PoseSet& data = state.task.data;
  for (const std::vector<int>& rows : groups_of_copies(data))
    add_finding(state, {.kind = FindingKind::duplicate_rows, .severity = Severity::warning, .rows = rows});
  for (const auto& entry : group_equal_rows(measured_values(data))) {
    const std::vector<int>& rows = entry.second;  // clang 14 captures no structured binding
    const auto same_joints = [&](int row) { return data.joints.col(row) == data.joints.col(rows.front()); };
    if (!std::all_of(rows.begin(), rows.end(), same_joints))
      add_finding(state, {.kind = FindingKind::measurement_repeated, .severity = Severity::warning, .rows = rows});
  }
}

void check_target_rigidity(DiagnosisState& state) {
  const PoseSet& data = state.task.data;
  for (const auto& [targets, pair] : target_pairs(data))
    if (pair.rows.size() >= thresholds::min_rigidity_rows)
      check_target_pair(state, {target_name(data, targets.first), target_name(data, targets.second)}, pair);
}

}  // namespace kinfer::calibrate
