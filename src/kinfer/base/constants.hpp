// SPDX-License-Identifier: Apache-2.0
// Physical constants.
#pragma once

namespace kinfer {

/// [m/s²] Conventional standard value of the acceleration of free fall (3rd CGPM, 1901).
inline constexpr double standard_gravity = 9.80665;

}  // namespace kinfer
