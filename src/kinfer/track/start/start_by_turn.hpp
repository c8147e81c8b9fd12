// SPDX-License-Identifier: Apache-2.0
// What a turn of a sensor's mounting makes of the posture that gravity shows at a start.
#pragma once

#include "kinfer/track/filter/chain_filter.hpp"
#include "kinfer/track/start/initial_posture.hpp"

namespace kinfer::track {

/// Tells a filter that has just started in `posture`, found in `block`, how its state follows from the turns of the
/// sensors. By differences; positions that count from here follow from none.
void follow_turns(const InitialPosture& posture, const BlockMeasurement& block, const std::vector<PositionGuess>& guess,
                  ChainFilter& filter);

}  // namespace kinfer::track
