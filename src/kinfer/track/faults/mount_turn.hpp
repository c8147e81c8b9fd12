// SPDX-License-Identifier: Apache-2.0
// A turn of a sensor's mounting in the states of the filter on a chain: turned by θ it measures
// exp([θ]×) z ≈ (I + [θ]×) z with both instruments, so that θ is what the antisymmetric parts of both scale matrices
// have in common.
#pragma once

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

struct MountTurn {
  Vec3 mean = Vec3::Zero();        ///< [rad] in the sensor's frame
  Mat3 covariance = Mat3::Zero();  ///< [rad²]
};

/// The mean of both antisymmetric parts; never quite certain, so that there are odds for and against it.
MountTurn mount_turn(const ChainFilter& filter, std::size_t sensor);

/// Its angle, with the standard deviation along its direction.
SensorTurn size_of(const MountTurn& turn);

/// Adds a turn of the sensor's mounting to what is unknown of it, of this variance [rad²] about each axis.
void loosen_mount(ChainFilter& filter, std::size_t sensor, double variance);

/// By how much the data that led from one belief about a turn to another one are likelier, ln, if the turn is
/// distributed as `supposed` than as `before`. Bayesian, with Gaussians.
double log_odds_of(const MountTurn& supposed, const MountTurn& before, const MountTurn& after);

}  // namespace kinfer::track
