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
std::vector<PositionGuess> position_guesses(const TrackingModel& tracking, const std::vector<ModelPosition>& positions,
                                            const std::optional<VectorXd>& start);

/// Of a joint with one turning position, at `time` [s]. One without a range may be anywhere.
LastPosition last_position(const TrackingJoint& joint, const TrackState& state, double time, double acceleration_sd);

}  // namespace kinfer::track
