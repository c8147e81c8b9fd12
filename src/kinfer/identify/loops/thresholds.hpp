// SPDX-License-Identifier: Apache-2.0
// Priors of kinematic loops.
#pragma once

#include "kinfer/base/threshold.hpp"

namespace kinfer::identify {

/// [m] Largest play of the pins of a linkage, and error of the estimated motion beside that of its orientations; per
/// component; down to a hundredth of it is as likely. Larger finds loops of more play, and coincidences. Simulated
/// linkages leave 0.02 to 0.07 mm, other pairs 35 mm and more.
inline constexpr double max_loop_point_sd = 3e-3;

/// [rad] Largest misalignment of a closing joint's axes, likewise: play, and errors of the estimated orientations.
inline constexpr double max_loop_axis_sd = 5e-3;

/// ln of the odds that two bodies which the tree does not join share a revolute joint, before anything is measured: one
/// pair in ten thousand. Larger finds more loops. In 120 recordings without a loop no pair gained from what was
/// measured.
inline constexpr double loop_log_prior_odds = -9.2;

/// ln of the posterior odds from which a loop is closed: 20 to 1.
KINFER_THRESHOLD(identify, min_loop_log_odds, 3.0);

/// [rad] Range of every joint of a loop. Joints that move less tell nothing about it.
inline constexpr double min_loop_joint_range = 0.1;

/// [rad] Largest difference of a joint position from which two positions of a machine count as different: estimation
/// errors of nearer ones are alike. Smaller counts more positions as evidence.
inline constexpr double min_position_difference = 0.03;

/// [m], [rad] Standard deviations of a closed loop's gap in a second: play stays alike for about so long.
inline constexpr double closure_point_sd = 1e-3, closure_axis_sd = 2e-3;

/// Times at which a loop is held closed; more of them cost memory in recordings of an hour.
inline constexpr int max_closure_times = 2000;

}  // namespace kinfer::identify
