// SPDX-License-Identifier: Apache-2.0
// The revolute joint that fits best between two bodies whose relative motion is known: a line fixed in each.
//
// With first_T_second = (R, t) at each time, the axes a and b maximise Σ aᵀ R b (the largest singular pair of Σ R), and
// the points minimise Σ |t + R p_second − p_first|², of minimum norm along the axis.
#pragma once

#include <span>
#include <vector>

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/geometry/pose.hpp"

namespace kinfer::identify {

struct ClosingJoint {
  InsBody joint{};            ///< revolute: A and p on the first body, B and c on the second
  double gap = 0.0;           ///< [m] rms distance of the two points, components across the axis
  double misalignment = 0.0;  ///< [rad] rms angle between the two axes
  double rotation = 0.0;      ///< [rad] rms rotation about the axis, around its mean
};

/// `first_T_second`: at least three different poses.
ClosingJoint fit_closing_joint(std::span<const Pose> first_T_second);

}  // namespace kinfer::identify
