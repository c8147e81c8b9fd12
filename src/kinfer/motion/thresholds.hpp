// SPDX-License-Identifier: Apache-2.0
// Numbers of the posture search. Set on the chains of tests/laws (5 to 7 joints, 2000 random poses each), where a third
// or three times of damping, half of worthwhile_decrease and twice the longest step change the mean time by less than
// 10 %.
#pragma once

namespace kinfer::motion::thresholds {

/// [1] of the squared weighted error; larger: shorter steps far from the target, more of them.
inline constexpr double damping = 0.01;
inline constexpr double least_damping = 1e-14;  ///< [1] keeps singular systems solvable
inline constexpr double longest_step = 0.8;     ///< [rad] or units of one joint; larger leaves the start's posture
inline constexpr int steps = 60;                ///< of one start
/// Every so many steps the error must have fallen to this part, or the start is left. Larger: fewer starts, longer.
inline constexpr int judged_steps = 5;
inline constexpr double worthwhile_decrease = 0.6;
inline constexpr int patient_steps = 200;    ///< inside the limits, or of a machine that deviates from the rigid chain
inline constexpr double near_target = 1e-3;  ///< [1] weighted error at which the way is taken to end in a singularity
inline constexpr int approach_steps = 12;    ///< of a redundant chain towards the preferred posture
inline constexpr double approach_tolerance = 1e-4;  ///< [rad] or units of steps at which it has arrived
/// [1] weighted error to which the steps of the approach are corrected, but for the last; larger: distances to the
/// preferred posture no longer tell whether a step led nearer (at 1e-3 half of the postures found are unfinished ones).
inline constexpr double rough_correction = 1e-6;
/// [m] and [rad] by which targets of six decimals are rounded, quaternions included.
inline constexpr double rounded_target = 2e-6;
inline constexpr double same_posture = 1e-3;  ///< [rad] apart

// ---- paths ----
inline constexpr double path_step = 5e-3;        ///< [s] at which lines of the tool are examined
inline constexpr double most_path_steps = 20e3;  ///< of a long path; its steps are longer then
inline constexpr double path_jump = 0.2;         ///< [rad] or [m] of a joint in one step: another posture
/// [1] smallest over largest singular value of the Jacobian, lengths divided by the distance of the tool; larger
/// refuses lines farther from singular postures.
inline constexpr double singular_path = 1e-3;
inline constexpr double slow_down_margin = 1.02;  ///< [1] for what lies between the steps
inline constexpr int profile_steps = 4000;        ///< to find the peak speed of a line; 10 to 60 are usual
inline constexpr double least_move = 1e-100;      ///< [rad] or [m] of a joint below which neighbours are equal
inline constexpr double most_samples = 2e6;       ///< of a path; more are refused before the work
inline constexpr double most_tool_samples = 5e5;  ///< the same along lines of the tool: each takes 40 us and more

// ---- corners ----
inline constexpr double least_cut = 1e-9;               ///< [rad] or [m] below which corners are stops
inline constexpr double least_corner_speed = 1e-12;     ///< [1] of the fastest on its lines; slower corners are stops
inline constexpr double corner_steps_per_octave = 8.0;  ///< of the speeds among which that of a corner is chosen
inline constexpr int corner_steps = 65;                 ///< larger: also slower corners
inline constexpr double largest_corner_change = 2.0;  ///< [octaves] of the first refinement; smaller: more local optima
inline constexpr double least_corner_change = 1e-3;   ///< [octaves] of the last

}  // namespace kinfer::motion::thresholds
