// SPDX-License-Identifier: Apache-2.0
// Joint type of two segments: the most probable one given their relative rotation and accelerations (type_odds.hpp).
#pragma once

#include <array>
#include <optional>

#include "kinfer/evidence/facts/estimated_joint_type.hpp"
#include "kinfer/identify/structure/segment_tree.hpp"
#include "kinfer/identify/structure/type_odds.hpp"

namespace kinfer::identify {

struct JointTypeEvidence {
  EstimatedJointType type = EstimatedJointType::revolute;
  std::array<double, 3> rates{};          ///< [rad/s] rms relative angular velocity, principal directions, descending
  std::array<double, 3> accelerations{};  ///< [m/s²] likewise of the residual at the common point
  /// Of each type; none of two segments without a connection.
  std::optional<JointTypeProbabilities> probabilities{};
  Vec3 axis_in_parent = Vec3::UnitZ();  ///< of rotation or translation; universal joint: the axis fixed in the parent
  Vec3 axis_in_child = Vec3::UnitZ();   ///< likewise
};

/// Of every pair of the tree, in its order (one per segment except the root). `motion`: with consistent headings.
std::vector<JointTypeEvidence> joint_types(const RecordedMotion& motion, const SegmentTree& tree);

}  // namespace kinfer::identify
