// SPDX-License-Identifier: Apache-2.0
// Limits of the search for the joints.
#pragma once

#include <cstddef>

namespace kinfer::identify {

/// Rows in which a joint moves; larger refuses shorter recordings. Data not recorded.
inline constexpr std::size_t min_informative_rows = 64;

/// Held-out rows on which a searched link is evaluated.
inline constexpr std::size_t evaluation_rows = 2000;

}  // namespace kinfer::identify
