// SPDX-License-Identifier: Apache-2.0
// Thresholds of segment tree and joint types.
// What half and double of those in KINFER_THRESHOLD do to the figures: docs/development/thresholds.md.
#pragma once

#include <cstddef>

#include "kinfer/base/threshold.hpp"

namespace kinfer::identify {

/// [nats per row] Gap of a given link to the one that it replaces from which it is a fault: twice the unexplained
/// motion. Smaller calls more given trees wrong. Data not recorded.
inline constexpr double decisive_link_gap = 0.7;

/// Rows that count as one independent sample against the priors of a pair's world rotation: orientation errors vary
/// slowly. Larger trusts the priors more. Data not recorded.
inline constexpr double rows_per_independent_sample = 300.0;

/// Rows of the pair fits; more did not change the order. Data not recorded.
inline constexpr std::size_t tree_rows = 1500;

/// Rows that the joint types are decided on. Data not recorded.
inline constexpr std::size_t joint_type_rows = 1500;

/// Factor by which a prismatic joint's translation must exceed the residual across it: errors are isotropic. Larger
/// finds fewer prismatic joints. Set on the simulated machines.
KINFER_THRESHOLD(identify, prismatic_dominance, 1.5);

/// [rad/s] Relative angular velocity of two INS without relative motion. Set, like the next four, on the simulated
/// machines and on measured chains (DIODEM).
KINFER_THRESHOLD(identify, relative_rate_noise, 3e-3);

/// Scale and orientation errors as a share of the angular velocity, least; larger calls more joints rigid or revolute.
inline constexpr double min_rate_error_share = 0.02;

/// Likewise, largest: soft mounts.
inline constexpr double max_rate_error_share = 0.1;

/// Factor on the errors below which nothing counts as motion; larger finds simpler joints.
KINFER_THRESHOLD(identify, motion_significance, 2.5);

/// [m/s²] Residual of a rigid pair: rotating biases, tilts; larger finds fewer prismatic joints.
inline constexpr double rigid_acceleration_noise = 0.03;

/// [rad/s] rms within a window above which a segment moves. Set, like the next three, on the excavator of paper 1.
inline constexpr double moving_rate = 0.05;

/// [m/s²] Likewise, relative to rest: prismatic joints do not rotate.
inline constexpr double moving_acceleration = 0.25;

/// [s] Window in which a segment moves or rests.
inline constexpr double phase_window = 0.25;

/// [s] Shorter phases are transitions.
inline constexpr double min_phase_duration = 1.0;

/// [m] Prior of the lever arms of a pair. Priors and floors of the pair fit are those of sensors with 20-30 mg of bias.
inline constexpr double lever_arm_sd = 3.0;

/// [m/s²] Prior of an accelerometer bias: 30 mg.
inline constexpr double pair_bias_sd = 0.3;

/// [m/s²] Residual of the best INS; smaller differences are not informative.
inline constexpr double pair_acceleration_floor = 0.01;

/// [rad/s] Likewise.
inline constexpr double pair_rate_floor = 3e-3;

/// [nats] Largest code of a pair's main axis of relative rotation. Larger takes the bars of a parallelogram for one
/// body: of 40 simulated linkages 40, 37, 28, 26 have a true tree at 1, 1.5, 2.3, 3 (19 without a limit); smaller makes
/// the other trees less certain: of 270 all are right, the least margin is 1.06, 2.55, 3.06, 3.17 at 0, 1, 1.5, 3
/// (3.91).
KINFER_THRESHOLD(identify, informative_rotation, 1.0);

/// [rad] Prior of the difference of two magnetometers' headings.
inline constexpr double magnetic_heading_sd = 0.5;

/// [rad/s] Prior of the drift of a heading without magnetometer.
inline constexpr double heading_drift_sd = 2e-3;

/// [rad] Prior of the tilt between two verticals: accelerometers of 20 mg.
inline constexpr double vertical_tilt_sd = 0.03;

}  // namespace kinfer::identify
