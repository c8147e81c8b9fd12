// What earlier calibrations of robots of the same kind tell about the next one: a Gaussian prior.
#pragma once

#include <span>

#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

/// The free parameters of the joints get the fleet's mean and full covariance as their prior. The nominal model with
/// its tolerances T (diagonal) counts as one more robot, so that a fleet of few is not believed too much and every
/// covariance is positive definite:
///   mean = (nominal + Σ x_k) / (1 + K),   covariance = (T² + Σ (x_k − mean)(x_k − mean)ᵀ) / (1 + K)
/// Base and tool belong to a set-up, not to the robot, and keep their priors. Each robot must have the joints of
/// `nominal`.
ParameterSet with_fleet_prior(ParameterSet set, std::span<const Chain> fleet);

/// The joints' numbers of `earlier` in `chain`; base and tool stay. Both must have the same joints.
Chain with_joint_numbers_of(const Chain& chain, const Chain& earlier, const ParameterSet& set);

/// True when both chains have as many joints of the same types and conventions, so that parameters mean the same.
bool same_kind(const Chain& a, const Chain& b);

}  // namespace kinfer
