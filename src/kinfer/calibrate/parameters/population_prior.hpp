// SPDX-License-Identifier: Apache-2.0
// A Gaussian prior from earlier calibrations of robots of the same type.
#pragma once

#include <span>

#include "kinfer/evidence/fleet/population.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer::calibrate {

/// The free joint parameters get the population's mean and full covariance as their prior. The nominal model with its
/// tolerances T (diagonal) counts as one more robot, so that a small population is not overweighted and the covariance
/// is always positive definite:
///   mean = (nominal + Σ x_k) / (1 + K),   covariance = (T² + Σ (x_k − mean)(x_k − mean)ᵀ) / (1 + K)
/// Base and tool belong to a set-up, not to the robot, and keep their priors. Each chain of `robot_population` must
/// have the joints that the set refers to.
ParameterSet with_population_prior(ParameterSet set, std::span<const Chain> robot_population);

/// The free joint parameters that `population` names get its mean and their block of its covariance; others keep their
/// tolerances.
ParameterSet with_population_prior(ParameterSet set, const PopulationPrior& population);

/// `chain` with the joint parameters of `earlier`; base and tool are kept. Both must have the same joints.
Chain with_joint_parameters_of(const Chain& chain, const Chain& earlier, const ParameterSet& set);

}  // namespace kinfer::calibrate
