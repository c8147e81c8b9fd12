// SPDX-License-Identifier: Apache-2.0
// Thresholds on faults of a recording.
// What half and double of those in KINFER_THRESHOLD do to the figures: docs/development/thresholds.md.
#pragma once

#include <cstddef>

#include "kinfer/base/threshold.hpp"

namespace kinfer::identify {

/// [rad/s] Angular velocity of a row that tells something about a mounting. Data not recorded.
inline constexpr double informative_rate = 0.05;

/// Rows on either side of a remounting; larger misses those near the ends. Data not recorded.
inline constexpr std::size_t min_rows_beside_split = 100;

/// Factor on the usual residual beyond which a joint's relation does not hold. Larger finds fewer remountings; seen
/// from 3 degrees or 3 cm on in simulated drives.
KINFER_THRESHOLD(identify, broken_relation_factor, 3.0);

/// Factor on the usual residual below which a relation holds. Same data.
inline constexpr double holding_relation_factor = 3.0;

/// Residual over that of the best split below which a split is in the interval of the event; larger widens the
/// interval. Data not recorded.
inline constexpr double max_split_ratio_to_best = 1.5;

/// Share of the relative angular velocity off its axis up to which a pair counts as a revolute joint. Simulated
/// linkage.
inline constexpr double max_revolute_off_axis_share = 0.1;

/// [rad/s] rms relative angular velocity below which two segments may share a prismatic joint. Data not recorded.
inline constexpr double min_rotating_rate = 0.02;

/// [s] Scatter of clock offsets among sensors on one clock, since each segment also moves by itself; the comparison of
/// angular velocities is good to 1-3 ms. Larger gives fewer sensors a clock of their own.
inline constexpr double usual_offset_scatter = 6e-3;

/// [s] Clock correction without effect on segment tree and joint types; larger repeats these steps less often. Data not
/// recorded.
inline constexpr double negligible_shift = 1e-3;

/// [s] Smaller clock corrections are not reported. Data not recorded.
inline constexpr double min_reported_shift = 2e-4;

/// [nats per row] Decrease of the tree's length that justifies a clock of its own for a sensor. Data not recorded.
inline constexpr double min_own_clock_gain = 0.3;

/// A link is no joint if its residual exceeds both `residual` [m/s²] and `factor` times that of the tree's links.
/// Larger separates fewer sensors.
struct NoJointThreshold {
  double residual, factor;
};
/// Three segments and more on either side. None of 225 simulated logs is cut at this (docs/methods/faults.md).
inline constexpr NoJointThreshold machine_threshold{.residual = 0.05, .factor = 4.0};
/// Fewer segments: a joint with a clipping sensor has up to 8 times the usual residual.
inline constexpr NoJointThreshold part_threshold{.residual = 0.1, .factor = 10.0};

/// [s] Mean piece between the gaps of a sensor below which its orientation explains that it fits to no other one. One
/// simulated log with pieces of 1.5, 2.5 s (does not fit) and 4 s (fits).
inline constexpr double least_piece = 4.0;

/// [nats per row] Gain over shifted recordings below which two segments have nothing to do with each other; larger
/// separates more sensors. Unrelated sensors gain at most 1.3, joints 1.7 (one of a pendulum, the others 6 and more).
KINFER_THRESHOLD(identify, no_connection_gain, 1.5);

/// [nats per row] Gain from which a connection is that of a joint; larger asks for care more often. Loose segments of
/// one running body gain 0.5 to 6, knees 5, joints of machines 6 to 20.
KINFER_THRESHOLD(identify, strong_connection_gain, 5.0);

/// [m/s²] rms residual that is no evidence against a joint, whatever it explains: gentle drives. Larger: asks for care
/// less often.
inline constexpr double small_residual = 0.1;

/// [nats per row] By which both halves of a recording may exceed its whole; larger finds fewer mixed recordings. Sound
/// logs reach 1.3 (450 joints of simulated machines), those of real machines 0.2.
inline constexpr double max_gain_of_halves = 2.5;

/// [nats per row] By which a pair's fit must be better in one part of a recording than in the other for it to be a
/// joint there only; larger finds fewer mixed recordings. Joints of simulated machines differ by 1.3 between halves,
/// pairs whose sensor was exchanged by 6 to 20 (ten logs).
inline constexpr double lost_joint_distance = 4.0;

/// [m/s²] rms acceleration, and
inline constexpr double min_connection_excitation = 0.05;
/// [rad/s] rms angular velocity, that a connection must explain; below both there is no evidence. Larger: judges fewer.
inline constexpr double min_connection_rate = 0.02;

/// Factor on a pair's residual in one half of the recording by which the other half must be excited, so that it is told
/// that the pair is not connected there; larger finds fewer mixed recordings.
inline constexpr double excited_residual_ratio = 5.0;

/// [s] Shorter halves of a recording are not judged by themselves: shifts by an eighth of it are too short.
inline constexpr double min_connection_time = 8.0;

/// Of the nearest others with which a sensor that is left out is compared in parts of the recording. Larger: time that
/// grows with the square of the number of sensors. All others, where the recording has seven sensors.
inline constexpr std::size_t max_partners = 6;

}  // namespace kinfer::identify
