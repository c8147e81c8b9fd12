// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/settled_start.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "kinfer/base/angle.hpp"
#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Revolute positions that gravity shows, but not to a few degrees.
std::vector<Index> uncertain_positions(const InitialPosture& posture, const FilterModel& model) {
  std::vector<Index> uncertain;
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    if (model.bodies[b].motion != JointMotion::revolute) continue;
    const Index at = model.layout.position[b], row = model.layout.joint_state(at);
    const StartPosition& start = posture.positions[static_cast<std::size_t>(at)];
    if (start.is_known && posture.covariance(row, row) > min_settled_sd * min_settled_sd) uncertain.push_back(at);
  }
  return uncertain;
}

struct SettledStart {
  ChainState state;
  double log_likelihood = 0.0;  ///< of the first rows
};

/// Runs through the first rows, and moves `positions` of the start to where they place them.
double run_and_move(InitialPosture& start, ChainFilter trial, std::span<const BlockMeasurement> first_rows,
                    const std::vector<Index>& positions) {
  start_in(start, trial);
  while (!first_rows.empty() && first_rows.front().time <= trial.state().time) first_rows = first_rows.subspan(1);
  const double log_likelihood = trial.run(first_rows);
  const double since = trial.state().time - start.state.time;
  for (const Index at : positions) {
    const auto now = trial.state().joints.segment<position_states>(position_states * at);
    auto then = start.state.joints.segment<position_states>(position_states * at);
    then = now;
    then[1] -= since * now[2];
    then[0] -= since * (now[1] - 0.5 * since * now[2]);
  }
  return log_likelihood;
}

/// Begins again and again where the first rows place these positions, as long as that makes the rows likelier. What
/// instruments and geometry leave moves them each time, too, and at last to where no linearisation holds.
SettledStart settled(InitialPosture start, const ChainFilter& filter, std::span<const BlockMeasurement> first_rows,
                     const std::vector<Index>& positions) {
  SettledStart best{start.state, run_and_move(start, filter, first_rows, positions)};
  for (int round = 0; round < settling_rounds; ++round) {
    const ChainState moved = start.state;
    const double log_likelihood = run_and_move(start, filter, first_rows, positions);
    if (!(log_likelihood > best.log_likelihood)) break;
    best = {moved, log_likelihood};
  }
  return best;
}

/// Positions that may be anywhere: those of which motion hides more than gravity shows, and on a base that stands still
/// those that count from here, which are freed. An upright axis is never quite so: what little it shows must not
/// contradict where the joint is said to stand, or biases would take it up.
std::vector<Index> free_positions(InitialPosture& posture, const FilterModel& model) {
  std::vector<Index> freed;
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    if (model.bodies[b].motion != JointMotion::revolute) continue;
    const Index at = model.layout.position[b], row = model.layout.joint_state(at);
    StartPosition& start = posture.positions[static_cast<std::size_t>(at)];
    const bool counts_from_here = posture.state.base == BaseMode::still && !start.is_known && !start.is_unseen &&
                                  !start.lost_sd && start.is_blurred;
    if (counts_from_here) start.is_known = true, posture.covariance(row, row) = free_start_sd * free_start_sd;
    if (counts_from_here || start.is_rough) freed.push_back(at);
  }
  return freed;
}

}  // namespace

void start_in(const InitialPosture& posture, ChainFilter& filter) {
  const FilterModel& model = filter.model();
  filter.start(posture.state, posture.covariance);
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const Index at = model.layout.position[b];
    if (at < 0) continue;
    const StartPosition& start = posture.positions[static_cast<std::size_t>(at)];
    if (start.has_open_heading) filter.consider_heading(b);
    if (model.bodies[b].motion != JointMotion::revolute || start.is_known || start.is_unseen) continue;
    filter.count_from_here(at);
  }
}

void settle(InitialPosture& posture, const ChainFilter& filter, std::span<const BlockMeasurement> first_rows) {
  const FilterModel& model = filter.model();
  InitialPosture start = posture;
  const std::vector<Index> anywhere = free_positions(start, model), positions = uncertain_positions(start, model);
  if (positions.empty()) return;
  SettledStart best = settled(start, filter, first_rows, positions);
  for (const Index at : anywhere)
    for (int k = 1; k < settling_places; ++k) {
      InitialPosture place = start;
      place.state = best.state;
      place.state.joints[position_states * at] += 2.0 * std::numbers::pi * k / settling_places;
      SettledStart other = settled(std::move(place), filter, first_rows, positions);
      if (other.log_likelihood > best.log_likelihood) best = std::move(other);
    }
  // What is already known of a turn is not given up for a whole one.
  for (const Index at : positions) {
    double& q = best.state.joints[position_states * at];
    const double before = posture.state.joints[position_states * at];
    q = before + wrap_to_pi(q - before);
  }
  posture.state = best.state;
}

}  // namespace kinfer::track
