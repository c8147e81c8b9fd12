// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/position_guesses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/track/model/thresholds.hpp"
#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Of a joint with one turning position, at `time` [s]. One without a range may be anywhere.
LastPosition last_position(const TrackingJoint& joint, const TrackState& state, double time, double acceleration_sd) {
  LastPosition last{.time = time,
                    .value = state.q[joint.first_position],
                    .rate = state.qd[joint.first_position],
                    .sd = state.sd_q[joint.first_position],
                    .most_turned = max_position_sd,
                    .speed = std::numeric_limits<double>::infinity(),
                    .acceleration_sd = acceleration_sd};
  if (joint.range.empty()) return last;
  const auto& seen = joint.range.front();
  last.speed = seen.speed;
  last.most_turned = std::min(max_position_sd, 0.5 * (seen.upper - seen.lower));
  return last;
}

}  // namespace

std::vector<PositionGuess> position_guesses(const TrackingModel& tracking, const FilterModel& model,
                                            const std::vector<ModelPosition>& positions,
                                            const std::optional<VectorXd>& start) {
  std::vector<PositionGuess> guesses;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const ModelPosition& position = positions[i];
    PositionGuess guess{.value = 0.0, .sd = max_position_sd};
    if (position.q >= 0) {
      const TrackingJoint& joint = tracking.joints[static_cast<std::size_t>(position.joint)];
      const auto at = static_cast<std::size_t>(position.q - joint.first_position);
      if (at < joint.range.size()) {
        guess.value = 0.5 * (joint.range[at].lower + joint.range[at].upper);
        guess.sd = 0.5 * (joint.range[at].upper - joint.range[at].lower) + start_prismatic_margin;
      }
      const bool is_given = start && position.q < start->size() && !std::isnan((*start)[position.q]);
      if (is_given && model.unknown_zero(static_cast<Index>(i)))
        guess.stated = (*start)[position.q];
      else if (is_given)
        guess = {.value = (*start)[position.q], .sd = given_start_sd, .is_given = true};
    }
    guesses.push_back(guess);
  }
  return guesses;
}

void go_on_from(std::vector<PositionGuess>& guesses, const TrackingModel& tracking, const ChainFilter& filter,
                const std::vector<ModelPosition>& positions, const TrackState& state, double time) {
  for (std::size_t i = 0; i < guesses.size(); ++i) {
    guesses[i].is_given = false;
    if (positions[i].joint < 0) continue;
    const TrackingJoint& joint = tracking.joints[static_cast<std::size_t>(positions[i].joint)];
    if (joint.positions != 1 || joint.type == EstimatedJointType::prismatic) continue;
    guesses[i].last = last_position(joint, state, time, filter.model().positions[i].sd);
    if (!filter.model().unknown_zero(static_cast<Index>(i))) continue;
    const Index at = filter.model().layout.joint_state(static_cast<Index>(i));
    guesses[i].last->value += filter.state().start[static_cast<Index>(i)];
    guesses[i].last->sd = std::max(guesses[i].last->sd, std::sqrt(filter.covariance()(at, at)));
  }
}

}  // namespace kinfer::track
