// SPDX-License-Identifier: Apache-2.0
// Thresholds on what is reported of an identification.
#pragma once

#include <cstddef>

namespace kinfer::identify {

/// Margin of the segment tree (ratio) from which its order counts as safe; larger warns more often. Set on 225
/// simulated drives of six machines: no wrong tree had a larger margin.
inline constexpr double safe_margin = 2.0;

/// [m] Distance of a joint's point from a sensor beyond which no machine reaches, five times the prior of a lever arm:
/// such a point is an artefact. Larger accepts more of them.
inline constexpr double max_reach = 15.0;

/// [rad] Angle between consecutive axes below which only the sum of their offsets d is taken as observable; larger
/// reports more joints. Data not recorded.
inline constexpr double parallel_axes_angle = 0.05;

/// Factor on the acceleration beyond which more excitation is not recommended: beyond any machine's reserve. Larger
/// recommends it for less accurate joints. Data not recorded.
inline constexpr double max_excitation_factor = 10.0;

/// Bins of a trace: about one per two pixels of a wide screen.
inline constexpr std::size_t max_trace_bins = 500;

}  // namespace kinfer::identify
