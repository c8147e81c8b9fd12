// SPDX-License-Identifier: Apache-2.0
// Selection of the parameters to identify.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// The frames and fixtures that the measurements depend on: bases, tools (rotations only where orientations, tilts or
/// several targets are measured), targets and fixtures without a prior; fixtures whose kind has a prior and the
/// direction of gravity with theirs.
ParameterSet frame_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances = {});

/// The complete geometric set: those of frame_parameters, targets, a alpha d theta of every joint (x y z rx ry rz of a
/// URDF joint), beta where two axes are nearly parallel, and the gain of prismatic joints. All but the fixtures without
/// a prior have one, so that redundant parameters do not make the problem singular.
ParameterSet geometric_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances);

/// Parameters that change in a collision or when a motor is replaced: the offset of each actuated joint (theta, d of a
/// prismatic joint, or the origin of a URDF joint about or along its axis), with a prior of 3 deg or 10 mm; and the
/// parameters of geometric_parameters that do not belong to joints.
ParameterSet joint_offset_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances);

/// Paper 2, table 2: a alpha d theta of every joint only (base and tool stay fixed). An error for URDF chains.
Result<ParameterSet> paper_dh_parameters(const Chain& chain, const Tolerances& tolerances);

/// The named ones. An unknown name is an error that lists the known ones.
Result<ParameterSet> named_parameters(const Chain& chain, const Tolerances& tolerances,
                                      const std::vector<std::string>& names);

/// The set without the targets and fixtures that no row of `data` refers to.
ParameterSet restricted_to_data(ParameterSet set, const PoseSet& data);

/// The set with its prior means at the values of `chain`.
ParameterSet with_prior_means_at(ParameterSet set, const Chain& chain);

}  // namespace kinfer::calibrate
