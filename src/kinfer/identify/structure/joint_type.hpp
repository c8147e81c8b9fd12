// SPDX-License-Identifier: Apache-2.0
// Joint type of two segments by the minimum description length of their relative motion (Rissanen 1978): a degree of
// freedom is worth its parameters if its motion exceeds the measurement errors, evaluated on the number of independent
// samples instead of all samples.
#pragma once

#include <array>
#include <span>

#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/structure/segment_tree.hpp"

namespace kinfer::identify {

struct JointTypeOptions {
  double rate_noise = 3e-3;          ///< [rad/s] relative angular velocity of two INS without relative motion
  double min_error_share = 0.02;     ///< scale and orientation errors, share of the angular velocity: least
  double max_error_share = 0.1;      ///< likewise, largest: soft mounts
  double significance = 2.5;         ///< factor on the errors below which nothing counts as motion
  double acceleration_noise = 0.03;  ///< [m/s²] residual of a rigid pair: rotating biases, tilts
};

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
std::vector<JointTypeEvidence> joint_types(const RecordedMotion& motion, const SegmentTree& tree,
                                           const JointTypeOptions& options = {});

/// Effective number of independent samples, n (1 − r) / (1 + r), r the lag-one autocorrelation; at least 1.
double effective_samples(std::span<const double> series);

}  // namespace kinfer::identify
