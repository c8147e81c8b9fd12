// SPDX-License-Identifier: Apache-2.0
// Joints that are not searched: prismatic, universal, spherical and rigid ones, and revolute ones that turn by too
// little for a search, from their pair of sensors alone.
#pragma once

#include "kinfer/identify/joints/joint_result.hpp"
#include "kinfer/identify/structure/joint_type.hpp"

namespace kinfer::identify {

/// Bacterial programming has no prismatic joints (paper 1, section VI).
JointResult prismatic_joint(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                            const JointTypeEvidence& evidence);

/// Revolute, universal or spherical, as in the evidence: the pair's common point is the joint's centre.
JointResult joint_about_point(const RecordedMotion& motion, const SegmentTree& tree, std::size_t parent,
                              std::size_t child, const JointTypeEvidence& evidence);

/// Two sensors without relative motion: on the same segment, or on both sides of a joint that was not moved.
JointResult rigid_joint(const RecordedMotion& motion, std::size_t parent, std::size_t child);

}  // namespace kinfer::identify
