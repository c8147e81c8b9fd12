// SPDX-License-Identifier: Apache-2.0
// Thresholds and effort of pose planning. The data on which they were set are not recorded.
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace kinfer::plan::thresholds {

/// [1] rise of the criterion by which all redundant rows together may be left out. Larger calls more rows redundant.
inline constexpr double redundant_rise = 0.01;
/// Singular value above which the data say more of a combination of parameters than the tolerances do.
inline constexpr double informative = 1.0;
inline constexpr std::size_t random_draws = 15;       ///< random sequences of which the median is shown
inline constexpr Eigen::Index workspace_poses = 300;  ///< places where the tool error is predicted; more: slower
inline constexpr int worst_power = 8;  ///< of the power mean that approximates the maximum over places; larger: closer
inline constexpr int exchange_rounds = 12;  ///< rounds of Fedorov's exchange at most
/// Rounds and proposals of the refinement in joint space; more improve by less than a hundredth.
inline constexpr int refinement_rounds = 6, refinement_proposals = 150;
inline constexpr double refinement_gain = 1e-3;  ///< [1] relative gain of a round below which the refinement ends
inline constexpr int bound_rounds = 200;         ///< of the multiplicative algorithm at most
inline constexpr double bound_gap = 0.02;        ///< [1] of the mean square error: the lower bound is tight enough
inline constexpr int two_opt_rounds = 50;
inline constexpr double least_noise = 1e-6;  ///< [m], [rad] floor of the instrument's noise

}  // namespace kinfer::plan::thresholds
