// SPDX-License-Identifier: Apache-2.0
// Thresholds of the search for a link.
#pragma once

#include <cstddef>

namespace kinfer::identify {

/// Relative decrease of the cost from which a structure is better: many are different forms of the same chain. Data not
/// recorded.
inline constexpr double min_structure_gain = 1e-5;

/// [rad/s] A row in which the child rotates slower is not informative. Data not recorded.
inline constexpr double min_informative_rate = 0.02;

/// Cosine of the pitch below which a row is too near to gimbal lock for Euler angles: 6 degrees. Data not recorded.
inline constexpr double gimbal_lock_cosine = 0.1;

/// Generations without improvement, after which a local search among neighbours follows. Data not recorded.
inline constexpr int patience = 4;

/// Rows in the cost of a link: more average out more noise and take longer. Data not recorded.
inline constexpr int default_link_rows = 384;

}  // namespace kinfer::identify
