// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/joints/searched_joint.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/identify/geometry/identified_chain.hpp"
#include "kinfer/identify/joints/thresholds.hpp"

namespace kinfer::identify {
namespace {

constexpr std::size_t pose_rows = 100;  // poses from which an axis is computed

/// The revolute joint's angle nearest to these states, with its first two time derivatives.
JointSignal revolute_angle(const JointGeometry& joint, const std::vector<FrameState>& parent,
                           const std::vector<FrameState>& child) {
  JointSignal signal{.name = "angle", .angle = {}, .angular_velocity = {}, .angular_acceleration = {}};
  const Quat home(joint.home.rotation);
  for (std::size_t row = 0; row < parent.size(); ++row) {
    const Mat3 to_parent = parent[row].rotation.transpose();
    const Quat turn = Quat(Mat3(to_parent * child[row].rotation)) * home.conjugate();
    const Vec3 angular_velocity = child[row].angular_velocity - parent[row].angular_velocity;
    const Vec3 angular_acceleration = child[row].angular_acceleration - parent[row].angular_acceleration -
                                      parent[row].angular_velocity.cross(angular_velocity);
    signal.angle.push_back(2.0 * std::atan2(joint.axis_in_parent.dot(turn.vec()), turn.w()));
    signal.angular_velocity.push_back(joint.axis_in_parent.dot(to_parent * angular_velocity));
    signal.angular_acceleration.push_back(joint.axis_in_parent.dot(to_parent * angular_acceleration));
  }
  return signal;
}

LinkFit link_fit(const JRmse& j) {
  return {j.total, j.acceleration, j.orientation};
}

std::vector<std::size_t> rows_except(const std::vector<std::size_t>& rows, const std::vector<std::size_t>& excluded) {
  std::vector<std::size_t> remaining;
  std::ranges::set_difference(rows, excluded, std::back_inserter(remaining));
  return remaining;
}

GeometryEstimate geometry_of(const JointSearch& search, const LinkSolution& solution,
                             const std::vector<FrameState>& parent, const std::vector<FrameState>& measured,
                             const std::vector<FrameState>& predicted) {
  std::vector<SignalRow> poses;
  for (const std::size_t row : thin_rows(search.rows, pose_rows)) poses.push_back(signals_at(search.signals, row));
  GeometryEstimate estimate{fit_revolute_geometry(solution.leaves, poses), {}};
  estimate.precision = revolute_precision(estimate.geometry, parent, measured,
                                          revolute_angle(estimate.geometry, parent, predicted), solution.rows);
  return estimate;
}

LinkEvidence evidence_of(const JointSearch& search, LinkSolution solution, const std::vector<FrameState>& measured,
                         const std::vector<FrameState>& predicted, OrientationMetric metric) {
  const std::string& name = search.child.name;
  const auto held_out = thin_rows(rows_except(search.rows, solution.rows), evaluation_rows);
  return {.segment = name,
          .fitted = link_fit(j_rmse(predicted, measured, solution.rows, metric)),
          .holdout = link_fit(j_rmse(predicted, measured, held_out, metric)),
          .rows = static_cast<int>(solution.rows.size()),
          .found = leaf_dh_rows(name, solution.leaves, search.signals),
          .merged = leaf_dh_rows(name, merge_leaves(solution.leaves), search.signals),
          .evaluations = solution.evaluations,
          .generations = solution.generations,
          .best = std::move(solution.best),
          .median = std::move(solution.median)};
}

}  // namespace

JointResult search_joint(const JointSearch& search, const std::vector<FrameState>& chain_states,
                         const LinkEngine& engine, int threads, const Rng& rng, const Observer& observer) {
  const std::vector<FrameState> measured = measured_states(search.child);
  const std::vector<FrameState> parent = continues_chain(engine) ? chain_states : measured_states(search.parent);
  LinkSolution solution = search_link(engine, {parent, measured, search.signals, search.rows}, threads, rng, observer);
  JointResult result;
  result.states = propagate(parent, solution.leaves, search.signals);
  const GeometryEstimate geometry = geometry_of(search, solution, parent, measured, result.states);
  result.joint = joint_estimate(search.parent.name, search.child.name, geometry);
  result.dh = canonical_dh_rows(result.joint, geometry);
  if (const int uses = count_signal_uses(solution.leaves); uses > 1)
    result.notes.push_back(
        {IdentificationNoteKind::several_signals, {{"child", search.child.name}, {"signals", uses}}});
  result.search = evidence_of(search, std::move(solution), measured, result.states, orientation_metric(engine));
  return result;
}

}  // namespace kinfer::identify
