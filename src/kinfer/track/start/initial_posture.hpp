// SPDX-License-Identifier: Apache-2.0
// Where a chain is when tracking begins, in closed form from the first rows of its sensors.
//
// Gravity in two neighbouring sensors determines the joint between them: with u = Aᵀ f_p and w = Bᵀ f_c a revolute
// joint stands at q = atan2(u_y, u_x) − atan2(w_y, w_x), with standard deviation σ_f / (g sin β), β the axis' angle to
// the vertical. No rest is needed: what the joints' motion adds to gravity counts as error of f. The gyroscopes give
// the velocities.
#pragma once

#include <optional>

#include "kinfer/track/filter/chain_filter.hpp"
#include "kinfer/track/start/after_gap.hpp"

namespace kinfer::track {

/// Beliefs about joint positions: the user's, or the middle of what was seen.
struct PositionGuess {
  double value = 0.0, sd = 0.0;        ///< [rad] or [m]
  bool is_given = false;               ///< by the user
  std::optional<double> stated{};      ///< [rad] by the user, where the zero is unknown: nothing is known of its value
  std::optional<LastPosition> last{};  ///< before a gap: it goes on from there where gravity does not show it better
};

/// What is known of a joint position of the filter at the start.
struct StartPosition {
  bool is_known = false;  ///< by gravity or by the user
  /// Unknown because a sensor beside it, or before that, has no accelerometer: gravity would tell, and does not.
  bool is_unseen = false;
  bool is_blurred = false;          ///< motion hides most of what gravity shows
  bool is_rough = false;            ///< gravity shows it, but motion hides more: a later moment will be better
  bool has_open_heading = false;    ///< of a spherical joint: its heading is a guess, which motion will show
  std::optional<double> lost_sd{};  ///< [rad] of what it may have turned in a gap, where it goes on from before that
  double contradicts_given = 0.0;   ///< ln odds that the user's value is wrong, where gravity is believed instead
};

struct InitialPosture {
  ChainState state;
  MatrixXd covariance;  ///< of the fast states
  std::vector<StartPosition> positions;
};

/// Whether a body moves whose joint leads to this one: then motion shows how the joint stands, if gravity does not.
bool parent_moves(const FilterModel& model, std::size_t body, BaseMode base);

/// Whether accelerations tell the heading of a body's spherical joint where it moves. On slack mounts they do not:
/// their errors last, and the guess is the better one. That is where the identification's residuals beside the joint
/// are rather more than white noise.
bool motion_shows_heading(const FilterModel& model, std::size_t body);

/// [rad] Of the guess about a spherical joint's rotation about `up`, given in its rotating frame: anywhere in its
/// range.
double heading_sd(const FilterModel& model, std::size_t body, const std::vector<PositionGuess>& guess, const Vec3& up);

/// `block`: mean of the first rows. `guess`: of each joint position of the filter.
InitialPosture initial_posture(const FilterModel& model, const BlockMeasurement& block,
                               const std::vector<PositionGuess>& guess, BaseMode base);

}  // namespace kinfer::track
