// SPDX-License-Identifier: Apache-2.0
// Physical constants.
#pragma once

namespace kinfer {

/// [m/s²] Conventional standard value of the acceleration of free fall (3rd CGPM, 1901).
inline constexpr double standard_gravity = 9.80665;

/// [m/s²] Where people and machines are: from the highest mountains of the tropics to the Arctic sea (EGM2008 states
/// 9.764 for Huascarán and 9.834 for the Arctic Ocean). Evenly distributed between both, it is usual_gravity.
inline constexpr double least_gravity = 9.764, largest_gravity = 9.834;
inline constexpr double usual_gravity = 9.80, usual_gravity_sd = 0.02;

}  // namespace kinfer
