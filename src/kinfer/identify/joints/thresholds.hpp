// SPDX-License-Identifier: Apache-2.0
// Limits of the search for the joints.
#pragma once

#include <cstddef>

namespace kinfer::identify {

/// Rows in which a joint moves; larger refuses shorter recordings. Data not recorded.
inline constexpr std::size_t min_informative_rows = 64;

/// Held-out rows on which a searched link is evaluated.
inline constexpr std::size_t evaluation_rows = 2000;

/// Held-out cost of the joint that the fit found over that of the search's own from which the search contradicts the
/// fit, and the fit is made again from the search. Smaller fits twice more often; sound fits of simulated machines have
/// 1.0 to 1.07, with consumer sensors up to 1.3.
inline constexpr double min_search_advantage = 1.5;

/// Decrease of −2 log likelihood from which one of two starts is the better one: both may end at one optimum.
inline constexpr double min_likelihood_gain = 10.0;

}  // namespace kinfer::identify
