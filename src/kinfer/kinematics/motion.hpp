// How the frames of a chain move: velocities and accelerations by recursion from the base outwards
// (Luh, Walker, Paul 1980, the outward half of Newton-Euler).
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

/// Motion of every joint's frame (after the joint), in the order of the joints, for readings q and their first and
/// second derivatives (dof each). The chain is taken as rigid: compliance is left out. The base stands still.
std::vector<FrameMotion> joint_motions(const Chain& chain, ConstVectorRef q, ConstVectorRef qd, ConstVectorRef qdd);

/// Motion of a frame that is fixed on a moving one: a sensor on its segment, the tool on its flange.
FrameMotion carried(const FrameMotion& carrier, const Pose& carrier_T_frame);

}  // namespace kinfer
