// SPDX-License-Identifier: Apache-2.0
// The population of a fleet's robots from what the measurements of each say about it, by hierarchical least squares.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kinfer/evidence/fleet/population.hpp"
#include "kinfer/evidence/fleet/task_summary.hpp"

namespace kinfer::fleet {

/// Robots x_k ~ N(mean, covariance), of which the measurements say exp(−½ xᵀ Λ_k x + h_kᵀ x); expectation
/// maximisation over the x_k. A robot with few poses has a small Λ_k and moves mean and covariance little; one that is
/// farther off than 99.9 % weighs less by its squared distance.
/// The covariance is shrunk towards an uncorrelated one, as if this were that of `pseudo_robots` more robots; their
/// number is chosen by the likelihood of robots that were left out (three folds). Variances and mean are shrunk towards
/// the data sheet's tolerances and nominal values.
/// Only parameters that at least half of the robots estimated. None for fewer than two robots.
std::optional<PopulationPrior> fit_population(std::span<const ParameterInformation* const> robots);

}  // namespace kinfer::fleet
