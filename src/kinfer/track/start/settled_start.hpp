// SPDX-License-Identifier: Apache-2.0
// The start of a machine that moves: an iterated extended Kalman filter (Bell and Cathey 1993) over the first rows.
#pragma once

#include <span>

#include "kinfer/track/start/initial_posture.hpp"

namespace kinfer::track {

/// Starts the filter there. Positions that count from here are known.
void start_in(const InitialPosture& posture, ChainFilter& filter);

/// Where a machine moves, gravity places its joints degrees off, too far for one linearisation of what follows. The
/// filter runs through the first rows and begins again where they place the joints, as uncertain as before; of
/// positions that may be anywhere on the circle the most likely start is taken.
void settle(InitialPosture& posture, const ChainFilter& filter, std::span<const BlockMeasurement> first_rows);

}  // namespace kinfer::track
