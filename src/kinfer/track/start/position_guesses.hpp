// SPDX-License-Identifier: Apache-2.0
// Beliefs about joint positions before the first row, and before the first row after a gap.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/track/start/initial_posture.hpp"

namespace kinfer::track {

/// The user's, or the middle of what was seen. `start`: of each joint position of the model; NaN: not given.
std::vector<PositionGuess> position_guesses(const TrackingModel& tracking, const FilterModel& model,
                                            const std::vector<ModelPosition>& positions,
                                            const std::optional<VectorXd>& start);

/// Before the first row after a gap: what was stated of the first rows is no longer true, and joints with one turning
/// position were last as `state` has them at `time` [s]. Others keep their guess and have a grid of starts.
void go_on_from(std::vector<PositionGuess>& guesses, const TrackingModel& tracking, const ChainFilter& filter,
                const std::vector<ModelPosition>& positions, const TrackState& state, double time);

}  // namespace kinfer::track
