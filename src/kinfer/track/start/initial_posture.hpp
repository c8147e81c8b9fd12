// SPDX-License-Identifier: Apache-2.0
// Where a chain is when tracking begins, in closed form from the first rows of its sensors.
//
// Gravity in two neighbouring sensors determines the joint between them: with u = Aᵀ f_p and w = Bᵀ f_c a revolute
// joint stands at q = atan2(u_y, u_x) − atan2(w_y, w_x), with standard deviation σ_f / (g sin β), β the axis' angle to
// the vertical. No rest is needed: what the joints' motion adds to gravity counts as error of f. The gyroscopes give
// the velocities.
#pragma once

#include <span>

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

/// Beliefs about joint positions: the user's, or the middle of what was seen.
struct PositionGuess {
  double value = 0.0, sd = 0.0;  ///< [rad] or [m]
  bool is_given = false;         ///< by the user
  /// It is where it was before a gap, `since` [s] ago, when it moved at `rate`: it goes on from there at the mean of
  /// that rate and of the gyroscopes' now, where gravity does not show it better.
  bool is_last = false;
  double rate = 0.0, since = 0.0;
};

struct InitialPosture {
  ChainState state;
  MatrixXd covariance;         ///< of the fast states
  std::vector<bool> is_known;  ///< of each joint position of the filter: by gravity or by the user
  /// Unknown because a sensor beside it, or before that, has no accelerometer: gravity would tell, and does not.
  std::vector<bool> is_unseen;
  std::vector<bool> goes_on;     ///< from where it was before a gap
  std::vector<bool> is_blurred;  ///< motion hides most of what gravity shows
  bool is_rough = false;  ///< of some position motion hides more than gravity shows: a later moment will be better
};

/// `block`: mean of the first rows. `guess`: of each joint position of the filter.
InitialPosture initial_posture(const FilterModel& model, const BlockMeasurement& block,
                               const std::vector<PositionGuess>& guess, BaseMode base);

/// Starts the filter there. Positions that count from here are known.
void start_in(const InitialPosture& posture, ChainFilter& filter);

/// Where a machine moves, gravity places its joints degrees off, too far for one linearisation of what follows. The
/// filter runs through the first rows and begins again where they place the joints, as uncertain as before: an iterated
/// extended Kalman filter (Bell and Cathey 1993).
void settle(InitialPosture& posture, const ChainFilter& filter, std::span<const BlockMeasurement> first_rows);

}  // namespace kinfer::track
