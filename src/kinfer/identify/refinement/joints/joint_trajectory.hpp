// SPDX-License-Identifier: Apache-2.0
// Trajectories of the variables of a joint of the identified chain, from the splines of the continuous-time fit.
#pragma once

#include "kinfer/estimate/continuous/model/uniform_spline.hpp"
#include "kinfer/evidence/identification/traces.hpp"
#include "kinfer/geometry/cardan_angles.hpp"
#include "kinfer/identify/refinement/joints/refined_joint.hpp"
#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer::identify {

/// The rows of the motion that make one frame of the joint trajectory.
Binning trajectory_frames(const RecordedMotion& motion);

/// [s] Times of the joint trajectory: the first row of each frame.
std::vector<double> trajectory_times(const RecordedMotion& motion);

/// One row per joint variable, in the order of joint_axes, one column per time [rad] or [m]. `bodies`: as passed to
/// refined_joint, `zero` likewise. `coefficients`: of the splines of their joint positions, one row per degree of
/// freedom.
MatrixXd joint_trajectory(EstimatedJointType type, std::span<const InsBody> bodies, const JointGeometry& geometry,
                          std::span<const double> zero, const SplineGrid& grid, ConstMatrixRef coefficients,
                          std::span<const double> times);

/// Cardan axes of a spherical joint, in the parent: most rotation about the first, least about the second, whose angle
/// must stay within ±90°. `turns`: rotation vectors relative to joint position 0, in the parent, 3 x times.
Mat3 spherical_axes(ConstMatrixRef turns);

/// Rotation vectors of a spherical joint relative to its orientation at the begin of the recording, 3 x times.
MatrixXd spherical_rotation_vectors(const SplineGrid& grid, ConstMatrixRef coefficients, std::span<const double> times);

}  // namespace kinfer::identify
