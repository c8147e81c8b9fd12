// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/joints/searched_joint.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
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

FrameState at_row(const SegmentMotion& segment, std::size_t row) {
  return {segment.rotation[row], segment.angular_velocity[row], segment.angular_acceleration[row],
          segment.acceleration[row]};
}

/// The state of the child behind a revolute joint on the moving parent, by the joint's own motion.
FrameState child_state(const InsBody& joint, const FrameState& parent, const JointSignal& angle, std::size_t i) {
  const Mat3 to_parent = parent.rotation.transpose();
  const InsState moved = propagated(
      joint,
      {Vec3(angle.angle[i], 0.0, 0.0), Vec3(angle.angular_velocity[i], 0.0, 0.0),
       Vec3(angle.angular_acceleration[i], 0.0, 0.0)},
      {to_parent * parent.angular_velocity, to_parent * parent.angular_acceleration, to_parent * parent.acceleration});
  const Mat3 rotation = parent.rotation * joint.parent_R_axis * rot_z(angle.angle[i]) * joint.child_R_axis.transpose();
  return {rotation, rotation * moved.angular_velocity, rotation * moved.angular_acceleration, rotation * moved.force};
}

/// Rotation about the vertical that brings the first orientations closest to the second.
double heading_between(const std::vector<FrameState>& from, const std::vector<FrameState>& to) {
  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) sum += to[i].rotation * from[i].rotation.transpose();
  return std::atan2(sum(1, 0) - sum(0, 1), sum(0, 0) + sum(1, 1));
}

void turn_about_vertical(std::vector<FrameState>& states, double heading) {
  const Mat3 turn = rot_z(heading);
  for (FrameState& s : states)
    s = {turn * s.rotation, turn * s.angular_velocity, turn * s.angular_acceleration, turn * s.acceleration};
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

LinkEvidence evidence_of(const JointSearch& search, LinkSolution solution, const std::vector<std::size_t>& held_out,
                         const std::vector<FrameState>& measured, const std::vector<FrameState>& predicted,
                         OrientationMetric metric) {
  const std::string& name = search.child.name;
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
  result.fitted_rows = solution.rows;
  result.held_out_rows = thin_rows(rows_except(search.rows, solution.rows), evaluation_rows);
  result.search = evidence_of(search, std::move(solution), result.held_out_rows, measured, result.states,
                              orientation_metric(engine));
  return result;
}

LinkFit fit_of_joint(const JointEstimate& revolute, const SegmentMotion& parent, const SegmentMotion& child,
                     const std::vector<std::size_t>& rows, OrientationMetric metric) {
  InsBody joint =
      revolute_body(-1, -1, frame_with_z_along(revolute.axis_in_parent), frame_with_z_along(revolute.axis_in_child));
  joint.point_in_parent = revolute.point_in_parent;
  joint.point_in_child = revolute.point_in_child;
  JointGeometry geometry{
      .axis_in_parent = revolute.axis_in_parent, .axis_in_child = revolute.axis_in_child, .home = {}};
  geometry.home.rotation = joint.parent_R_axis * joint.child_R_axis.transpose();
  std::vector<FrameState> parents, measured, predicted;
  std::vector<std::size_t> all;
  for (const std::size_t row : rows) {
    all.push_back(parents.size());
    parents.push_back(at_row(parent, row));
    measured.push_back(at_row(child, row));
  }
  // The headings of the two orientations are arbitrary: a joint is judged at the best one between them.
  constexpr int heading_rounds = 8;
  for (int round = 0; round < heading_rounds; ++round) {
    const JointSignal angle = revolute_angle(geometry, parents, measured);
    predicted.clear();
    for (const std::size_t i : all) predicted.push_back(child_state(joint, parents[i], angle, i));
    if (round + 1 < heading_rounds) turn_about_vertical(parents, heading_between(predicted, measured));
  }
  return link_fit(j_rmse(predicted, measured, all, metric));
}

}  // namespace kinfer::identify
