// SPDX-License-Identifier: Apache-2.0
// Thresholds on what changed on a machine since its last identification.
#pragma once

#include <array>

namespace kinfer::identify {

/// Prior probabilities that one sensor was moved, and that one joint moved on one of its segments, between two
/// identifications; larger names more changes. Judgements: people knock against sensors, and pins hardly move.
inline constexpr double moved_sensor_probability = 0.02, moved_joint_probability = 0.005;

/// [rad], [m] Standard deviations per axis of a change, one as likely as the other: a mount that settled, a knock, a
/// sensor that was put back elsewhere. Judgements.
inline constexpr std::array<double, 3> change_angles{2e-3, 2e-2, 0.3}, change_distances{2e-3, 2e-2, 0.2};

/// [rad], [m] Prior standard deviation per axis of a change once it is certain: what the older log told of it is
/// forgotten. Larger forgets more.
inline constexpr double forgotten_angle = 1.0, forgotten_distance = 1.0;

/// [rad], [m] By which a parameter differs between any two logs: mounts settle, and second-order terms of the
/// comparison are left out. Larger names fewer changes. A judgement: a tenth of what industrial sensors show.
inline constexpr double same_angle = 3e-5, same_distance = 5e-5;

/// Standard deviation of a change's size, as a fraction of the largest prior's, from which the logs do not tell it.
inline constexpr double unknown_size = 0.5;

/// Changes per sensor of the machine beyond which a log is that of another machine; larger calls fewer logs so.
inline constexpr double max_changes_per_sensor = 0.5;

/// Inflations of all variances, one as likely as the other, by which the logs' standard deviations may be too small.
/// More of them ask for more evidence.
inline constexpr std::array<double, 3> variance_inflations{1.0, 2.0, 4.0};

}  // namespace kinfer::identify
