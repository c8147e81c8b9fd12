// SPDX-License-Identifier: Apache-2.0
// Probabilities of the joint types of all joints of a machine, from how far the relative motion of their segments
// strays from each type. The sizes of the errors of orientations s (mounts that give way, headings, play) and of
// accelerations a are unknown, but similar in all joints of a recording, and integrated out:
//   p(T_j) = Σ w(s, a) p(T_j | d_j, s, a),   w(s, a) ∝ p(s) p(a) Π_j Σ_T p(T) p(d_j | T, s, a).
#pragma once

#include <span>
#include <vector>

#include "kinfer/evidence/facts/estimated_joint_type.hpp"
#include "kinfer/identify/structure/rigid_rates.hpp"

namespace kinfer::identify {

/// What the relative motion of a pair leaves to each type: rms deviations of the best joint of that type.
struct MotionDeviations {
  double rotation = 0.0;      ///< [rad] from a constant orientation: of a rigid or prismatic joint an error
  double axis = 0.0;          ///< [rad] from one axis that is fixed in both: of a revolute joint an error
  double plane = 0.0;         ///< [rad] from a constant angle between two axes, one per segment: of a universal joint
  double axes_angle = 0.0;    ///< [rad] that angle
  double rate_share = 0.0;    ///< relative angular velocity as a share of the sensors'
  RigidRates rates{};         ///< what two sensors on one body do not explain of their angular velocities
  double acceleration = 0.0;  ///< [m/s²] from a common point, largest direction: an error unless it slides
  double acceleration_across = 0.0;  ///< [m/s²] likewise, second direction
  double acceleration_level = 0.0;   ///< [m/s²] rms acceleration of the segment that accelerates more
};

/// One per joint.
std::vector<JointTypeProbabilities> type_probabilities(std::span<const MotionDeviations> joints);

}  // namespace kinfer::identify
