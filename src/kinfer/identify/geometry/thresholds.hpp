// SPDX-License-Identifier: Apache-2.0
// Thresholds of the joint geometry.
#pragma once

#include <cstddef>

namespace kinfer::identify {

/// Sine of the angle between two axes below which their distance is that of parallel lines. Data not recorded.
inline constexpr double max_parallel_sine = 1e-3;

/// Sine of the angle between two lines below which Hayati's angle beta replaces d. Data not recorded.
inline constexpr double max_hayati_sine = 0.1;

/// [m] A lever direction of the searched geometry with a larger standard deviation is unobservable. Data not recorded.
inline constexpr double max_lever_sd = 0.5;

}  // namespace kinfer::identify
