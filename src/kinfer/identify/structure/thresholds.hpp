// SPDX-License-Identifier: Apache-2.0
// Thresholds of segment tree and joint types.
// What half and double of those in KINFER_THRESHOLD do to the figures: docs/development/thresholds.md.
#pragma once

#include <cstddef>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/threshold.hpp"
#include "kinfer/geometry/log_normal.hpp"

namespace kinfer::identify {

/// [nats per row] Gap of a given link to the one that it replaces from which it is a fault: twice the unexplained
/// motion. Smaller calls more given trees wrong. Data not recorded.
inline constexpr double decisive_link_gap = 0.7;

/// Rows that count as one independent sample against the priors of a pair's world rotation: orientation errors vary
/// slowly. Larger trusts the priors more. Data not recorded.
inline constexpr double rows_per_independent_sample = 300.0;

/// Rows of the pair fits; more did not change the order. Data not recorded.
inline constexpr std::size_t tree_rows = 1500;
/// Fewer rows tell nothing of a tree. Larger refuses short recordings. Data not recorded.
inline constexpr std::size_t least_tree_rows = 50;

/// Rows that the joint types are decided on. Data not recorded.
inline constexpr std::size_t joint_type_rows = 1500;

/// [rad/s] Relative angular velocity of two INS without relative motion. Set on the simulated machines and on DIODEM.
KINFER_THRESHOLD(identify, relative_rate_noise, 3e-3);

/// Joints of a machine before anything is measured: rigid, prismatic, revolute, universal, spherical.
inline constexpr double type_prior[] = {0.06, 0.05, 0.76, 0.03, 0.1};

/// [s] Headings drift little within that, at 1e-4 to 2e-3 rad/s. Shorter hides more of a slow second axis.
inline constexpr double heading_drift_window = 30.0;
/// Fewer are a short recording, which the figures of `orientation_error` are of.
inline constexpr std::size_t least_drift_windows = 4;
/// [1] a row, beside the squared sine of the axis' angle to the vertical: half of the drift at 0.6°.
inline constexpr double weight_of_no_drift = 1e-4;
inline constexpr int heading_drift_passes = 3;  ///< of axis and headings; the third changes nothing that counts

/// [rad] Deviation of a revolute joint's axis by errors, typical of a recording: 0.01 to 0.1° with rigid mounts and
/// industrial sensors, 0.3 to 1° with consumer ones, 0.03 to 0.8° on the iiwa and the pendulum, 1 to 3° on DIODEM and
/// on foam. Larger calls machines of spherical joints revolute; smaller calls soft mounts spherical joints.
inline constexpr LogNormal orientation_error{0.1 * degree, 1.0};

/// Spread of the errors' sizes among the joints of a recording, in logarithms: the iiwa's five differ by a factor
/// of 20.
inline constexpr double error_spread = 1.0;

/// [rad] Rotation of a joint that moves, rms. Smaller spreads call joints that turn by some tenths of a degree rigid:
/// of 546 joints of random machines (those of docs/development/results.md and the first of them) 10, 3, 2 of 32, 24, 20
/// that are rigid with 95 % do move at 1.3, 1.6, 1.9.
inline constexpr LogNormal joint_rotation{10.0 * degree, 1.6};

/// [rad] Rotation of a rigid pair by headings that drift, beside twice the errors of an axis: 0.02 to 0.1° with
/// industrial sensors, 0.1 to 1.4° with consumer ones.
inline constexpr double rigid_rotation_error = 0.2 * degree;

/// Relative angular velocity of a rigid pair as a share of the sensors': scales and axes of the gyroscopes, 0.001 to
/// 0.07 of simulated pairs.
inline constexpr LogNormal rigid_rate_share{0.02, 0.8};

/// [rad/s] What two sensors on one body do not explain of the angular velocities of a joint that moves: 0.02 to 1 of
/// simulated joints, 0.01 to 0.2 of an iiwa that moves slowly, 1 to 2 of DIODEM. Smaller spreads call joints rigid that
/// hardly move.
inline constexpr LogNormal joint_rate{0.3, 1.6};

/// The relative angular velocity over that.
inline constexpr LogNormal rate_ratio{1.3, 0.7};

/// The same of a rigid pair over what is expected: 0.92 to 1.06 times the noise of simulated ones (36 waved sticks of
/// three grades, 1 and 9 rad/s). Larger calls joints rigid that hardly move.
inline constexpr LogNormal rigid_residual{1.0, 0.7};

/// Of the angular velocity: what scales and misalignments of a gyroscope do not explain on one body (nonlinearity,
/// jitter of the time stamps, bodies that bend).
inline constexpr double rigid_residual_share = 0.003;

/// [1/s] Angular velocity of a mount that gives way by an angle: 0.01 rad/s at 1° on foam.
inline constexpr double mount_rate = 1.0;

/// Deviation across the main axis over the whole deviation, of errors.
inline constexpr LogNormal error_axis_ratio{0.4, 0.8};

/// Least over the mean deviation across an axis, of errors: 0.24 to 0.80 of simulated joints.
inline constexpr LogNormal error_plane_ratio{0.5, 0.4};

/// Least log density of such a ratio: gyroscopes with scale errors make errors in one direction (down to 0.07).
inline constexpr double min_ratio_density = -3.0;

/// [m/s²] Residual acceleration of the common point by errors, typical of a recording: 0.004 to 0.03 with industrial
/// sensors, 0.02 to 0.12 with consumer ones. Larger finds fewer prismatic joints.
inline constexpr LogNormal acceleration_error{0.02, 1.0};

/// Beside that, as a share of the segments' acceleration: scales, delays, levers. 0.0024 to 0.024 of rigid sticks that
/// are waved by hand at 10 to 38 m/s² (nonsense logs of seed 3); less than 0.01 of machines.
inline constexpr double acceleration_error_share = 0.006;

/// Spread of its sizes among the joints of a recording.
inline constexpr double acceleration_error_spread = 0.7;

/// Second over first direction of the same.
inline constexpr LogNormal error_across_ratio{0.75, 0.4};

/// [m/s²] Residual acceleration of a prismatic joint that moves: 0.07 to 1.5 of simulated ones.
inline constexpr LogNormal sliding_acceleration{0.4, 1.2};

/// Second over first direction of the same, Coriolis accelerations.
inline constexpr LogNormal sliding_across_ratio{0.3, 0.8};

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
