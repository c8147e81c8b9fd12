// Which of a robot's numbers are identified.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Base (6) and tool: its position, and its turn where orientations are measured.
ParameterSet frame_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances = {});

/// The complete geometric set: base, tool, a alpha d theta of every joint (x y z rx ry rz of a URDF joint), beta where
/// two axes are nearly parallel, gain of prismatic joints. All have priors, so that redundancy does no harm.
ParameterSet geometric_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances);

/// Paper 2, table 2: a alpha d theta of every joint, nothing else (base and tool as they are). An error for URDF
/// chains.
Result<ParameterSet> paper24_parameters(const Chain& chain, const Tolerances& tolerances);

/// The named ones. An unknown name is an error that lists the known ones.
Result<ParameterSet> named_parameters(const Chain& chain, const Tolerances& tolerances,
                                      const std::vector<std::string>& names);

/// The priors of the set are centred at the numbers of `chain`.
ParameterSet centred_at(ParameterSet set, const Chain& chain);

}  // namespace kinfer
