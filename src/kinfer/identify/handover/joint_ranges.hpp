// SPDX-License-Identifier: Apache-2.0
// How far and how fast a machine moved in the log that it was identified from.
#pragma once

#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/identify/handover/parameter_covariance.hpp"

namespace kinfer::identify {

/// Spline coefficients of a joint's positions in the fit, one row a degree of freedom; none of a rigid joint.
MatrixXd joint_splines(const InsFit& fit, const JointBodies& joint);

/// One for each position of the joint. Positions from its trajectory, speeds and accelerations from the splines: of the
/// three of a spherical joint, and of a loose revolute joint, the norm.
std::vector<TrackingRange> joint_ranges(const JointEstimate& joint, const SplineGrid& grid, ConstMatrixRef splines);

TrackingBase base_motion(const InsProblem& problem, const InsFit& fit);

}  // namespace kinfer::identify
