// SPDX-License-Identifier: Apache-2.0
// Settings of the start, with the data that they were set on.
#pragma once

#include <array>

namespace kinfer::track {

inline constexpr double start_length = 0.25;       ///< [s] of rows that determine the posture
inline constexpr double start_patience = 1.0;      ///< [s] in which a quieter moment is waited for
inline constexpr double max_observable_sd = 0.35;  ///< [rad] beyond that an angle is unobservable by gravity
/// [rad] Likewise by the error of an axis that may be anywhere on a cone, which is no normal distribution: a position
/// known so roughly bends what else is seen. Set on slopes of 7 to 30 degrees under an excavator whose upright axis was
/// known to 43 mrad in the base: changes of its position are off by 0.02 instead of 0.04 to 0.6 degrees.
inline constexpr double max_cone_sd = 0.05;
inline constexpr double cone_width = 0.1;       ///< of the axis' standard deviation across the cone, over that along it
inline constexpr double min_force_sd = 0.03;    ///< [m/s²] of gravity's direction from one sensor
inline constexpr double unseen_force_sd = 3.0;  ///< [m/s²] of a body without a sensor
inline constexpr double start_arm = 1.0;        ///< [m] typical arm of the centripetal acceleration
inline constexpr double min_settled_sd = 0.02;  ///< [rad] below that one linearisation is enough
inline constexpr int settling_rounds = 4;       ///< excavator, crane, arm and tree in motion change little in the last
inline constexpr double free_start_sd = 1.0;   ///< [rad] of a position that counts from here, while its place is sought
inline constexpr int settling_places = 6;      ///< on the circle, of a position that may be anywhere
inline constexpr double start_rate_sd = 0.05;  ///< [rad/s] of velocities by gyroscopes over the first rows
inline constexpr double start_prismatic_speed = 0.05;  ///< [m/s] of a prismatic joint
inline constexpr double start_heading_sd = 0.03;       ///< [rad] of a joint that is loose or between slack mounts
inline constexpr double start_velocity_sd = 0.3;       ///< [m/s] of the base
/// [rad] Of positions and attitude while the rows that they were read from are weighed: far beyond what biases make.
inline constexpr double weighed_start_sd = 0.1;
/// Of the change of biases from one power-up to the next. That gyroscopes change otherwise than accelerometers (they
/// are zeroed at each power-up, say) is so much less likely.
inline constexpr std::array power_up_shares{0.0, 0.2, 1.0};
inline constexpr double unlike_changes = 0.3;

inline constexpr int start_places = 18;  ///< of an angle that gravity does not determine
/// Updates that only settle velocities and accelerations: their evidence depends on how little was known of these.
inline constexpr int start_updates = 25;
/// [s] in which nothing tells places apart, after which they are given up: what began was no motion, or is over.
/// While places are open nothing that disagrees is named, so the first is short. Set on one machine with four joints,
/// on level ground after a power-up.
inline constexpr double untold_patience = 2.0, undecided_patience = 20.0;
inline constexpr double open_entropy = 1.0;            ///< [nat] three places or more, for which the first holds
inline constexpr double suspicion_again = 60.0;        ///< [s] after a suspicion that was none; not set on data
inline constexpr double usual_force_time = 1.0;        ///< [s] mean specific force, from which that of a motion differs
inline constexpr double start_log_odds = 30.0;         ///< ln: a place so much less likely than the best is dropped
inline constexpr double start_merge = 0.02;            ///< [rad] or [m] places so near are one
inline constexpr double prismatic_step = 0.1;          ///< [m] least distance of places along a prismatic joint
inline constexpr double given_start_sd = 0.02;         ///< [rad] or [m] of what the user states
inline constexpr double wrong_start_prior = 0.01;      ///< that it is a wrong number, or in a wrong unit
inline constexpr double wrong_start_log_odds = 3.0;    ///< ln: beyond that gravity is believed, and it is said
inline constexpr double start_prismatic_margin = 0.1;  ///< [m] beyond what was seen of a prismatic joint

}  // namespace kinfer::track
