// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kinfer {

/// [m] No coordinate of a machine is larger: those of a survey reach the size of the Earth. Readers refuse what is, and
/// so fits must not end there.
inline constexpr double largest_length = 2e7;

}  // namespace kinfer
