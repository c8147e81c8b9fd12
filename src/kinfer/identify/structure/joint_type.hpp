// SPDX-License-Identifier: Apache-2.0
// Joint type of two segments by the minimum description length of their relative motion (Rissanen 1978): a degree of
// freedom is worth its parameters if its motion exceeds the measurement errors, evaluated on the number of independent
// samples instead of all samples.
#pragma once

#include <array>

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/structure/segment_tree.hpp"

namespace kinfer::identify {

struct JointTypeEvidence {
  EstimatedJointType type = EstimatedJointType::revolute;
  std::array<double, 3> rates{};          ///< [rad/s] rms relative angular velocity, principal directions, descending
  std::array<double, 3> accelerations{};  ///< [m/s²] likewise of the residual at the common point
  double rate_error = 0.0;                ///< [rad/s] expected size of the errors
  double off_plane_rate = 0.0;  ///< [rad/s] rms relative angular velocity left by two axes, one fixed per segment
  Vec3 axis_in_parent = Vec3::UnitZ();  ///< of rotation or translation; universal joint: the axis fixed in the parent
  Vec3 axis_in_child = Vec3::UnitZ();   ///< likewise
};

/// Of every pair of the tree, in its order (one per segment except the root). `motion`: with consistent headings.
std::vector<JointTypeEvidence> joint_types(const RecordedMotion& motion, const SegmentTree& tree);

}  // namespace kinfer::identify
