// Which of a robot's numbers are identified.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// What the measurements refer to, as far as they see it: bases, tools (turned only where orientations, tilts or
/// several targets are measured), sockets, planes, all without a prior; anchors and the direction of gravity with
/// theirs.
ParameterSet frame_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances = {});

/// The complete geometric set: what frame_parameters lists and targets, a alpha d theta of every joint (x y z rx ry rz
/// of a URDF joint), beta where two axes are nearly parallel, gain of prismatic joints. All but sockets and planes have
/// priors, so that redundancy does no harm.
ParameterSet geometric_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances);

/// What may change when a robot is knocked or a motor is replaced: the offset of each joint that has a reading (theta,
/// or d of a slide, or the turn of a URDF joint about its axis), within 3 deg or 10 mm; and what geometric_parameters
/// lists besides the joints.
ParameterSet offset_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances);

/// Paper 2, table 2: a alpha d theta of every joint, nothing else (base and tool as they are). An error for URDF
/// chains.
Result<ParameterSet> paper24_parameters(const Chain& chain, const Tolerances& tolerances);

/// The named ones. An unknown name is an error that lists the known ones.
Result<ParameterSet> named_parameters(const Chain& chain, const Tolerances& tolerances,
                                      const std::vector<std::string>& names);

/// The set without targets, anchors, sockets and planes that no row of `data` refers to.
ParameterSet seen_in(ParameterSet set, const PoseSet& data);

/// The priors of the set are centred at the numbers of `chain`.
ParameterSet centred_at(ParameterSet set, const Chain& chain);

}  // namespace kinfer
