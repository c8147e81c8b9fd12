// SPDX-License-Identifier: Apache-2.0
// Initial estimate of every joint of the tree, from the two adjacent sensors alone or from the search of its link: good
// enough for the continuous-time fit to converge.
#pragma once

#include <optional>
#include <span>

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/structure/segment_tree.hpp"

namespace kinfer::identify {

/// The direction of a known machine's axis about which its positions count as positive.
struct PositiveAxis {
  Vec3 in_parent, in_child;
};

struct InitialJoint {
  std::size_t parent = 0, child = 0;  ///< segments
  EstimatedJointType type = EstimatedJointType::revolute;
  std::vector<InsBody> bodies{};  ///< in series; the last one carries the child's sensor
  std::vector<std::vector<double>>
      joint_positions{};                        ///< joint positions [rad] or [m] at the motion's rows, by freedom
  std::optional<PositiveAxis> positive_axis{};  ///< none: its largest coordinate in the parent is positive
};

/// Axes from the relative angular velocity, joint positions from the rotation about them, points from the pair fit.
InitialJoint estimate_initial_joint(const RecordedMotion& motion, const SegmentTree& tree, std::size_t parent,
                                    std::size_t child, EstimatedJointType type);

/// A revolute joint whose axis line is already known in both sensors' frames, as from the search of its link; joint
/// positions as above.
InitialJoint initial_joint_at(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                              const JointEstimate& revolute);

/// A joint whose bodies are known from an earlier identification, but for the sensors' biases and the joint positions.
/// Where the recording says otherwise of its axes, by more than the pair of sensors alone may err, as
/// estimate_initial_joint.
InitialJoint initial_joint_from(const RecordedMotion& motion, const SegmentTree& tree, std::size_t parent,
                                std::size_t child, EstimatedJointType type, std::span<const InsBody> known);

}  // namespace kinfer::identify
