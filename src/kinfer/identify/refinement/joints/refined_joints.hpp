// SPDX-License-Identifier: Apache-2.0
// All joints of a continuous-time fit as evidence, each with its share of the covariance and of the model errors.
#pragma once

#include "kinfer/estimate/continuous/solver/covariance.hpp"
#include "kinfer/estimate/continuous/solver/normal_equations.hpp"
#include "kinfer/identify/refinement/fits/low_frequency_fit.hpp"
#include "kinfer/identify/refinement/joints/refined_joint.hpp"

namespace kinfer::identify {

/// The joints of a fit, in the order of the task's starts.
std::vector<JointBodies> joint_bodies(const RefinementTask& task, const RefinementSetup& setup);

/// parameter_covariance of a fit.
MatrixXd covariance_of_parameters(const RefinementTask& task, const RefinementFit& fitted,
                                  const InsCovariance& covariance, const ModelError& error);

/// In the order of the task's starts, with the names of their segments.
std::vector<RefinedJoint> make_joints(const RefinementTask& task, const RefinementFit& fitted,
                                      const InsCovariance& covariance, const ModelError& error);

/// The joints that close loops, in the order of the fit's closures; without names and trajectory.
std::vector<JointEstimate> closing_joints(const InsFit& fit, const InsCovariance& covariance);

/// Of each body of a joint: the splines at the time for which its zero is stated.
std::vector<SplineMarginal> zero_marginals(const RefinementTask& task, const RefinementFit& fitted,
                                           const InsSystem& system, const JointBodies& joint);

}  // namespace kinfer::identify
