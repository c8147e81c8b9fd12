// SPDX-License-Identifier: Apache-2.0
// Velocities and accelerations of the frames of a chain by recursion from the base outwards (Luh, Walker, Paul 1980:
// the outward recursion of Newton-Euler).
#pragma once

#include <vector>

#include "kinfer/kinematics/forward.hpp"

namespace kinfer {

/// A moving frame; vectors in world coordinates, velocity and acceleration are those of the frame's origin.
struct FrameMotion {
  Pose pose;
  Vec3 omega = Vec3::Zero();         ///< [rad/s]
  Vec3 alpha = Vec3::Zero();         ///< [rad/s²]
  Vec3 velocity = Vec3::Zero();      ///< [m/s]
  Vec3 acceleration = Vec3::Zero();  ///< [m/s²], gravity not included
};

/// Motion of every joint frame (after the joint), in the order of the joints, for joint positions q and their first and
/// second derivatives (dof each). The chain is taken as rigid: compliance is ignored. The base is fixed.
std::vector<FrameMotion> joint_motions(const Chain& chain, ConstVectorRef q, ConstVectorRef qd, ConstVectorRef qdd);

/// Motion of a frame that is fixed to a moving one: a sensor on its segment, the tool on its flange.
FrameMotion attached_frame_motion(const FrameMotion& parent, const Pose& parent_T_frame);

}  // namespace kinfer
