// SPDX-License-Identifier: Apache-2.0
// Inverse kinematics: damped least-squares steps (Levenberg 1944, Marquardt 1963) inside the joint limits.
#pragma once

#include "kinfer/kinematics/forward.hpp"

namespace kinfer {

enum class InverseStatus {
  reached,
  unreachable,      ///< no small change of the joint positions brings the tool closer
  at_limit,         ///< the same, and a joint at its limit is in the way
  near_singular,    ///< iterations used up near a kinematic singularity
  iteration_limit,  ///< iterations used up elsewhere
};

struct InverseOptions {
  double position_tolerance = 1e-9;  ///< [m]
  double angle_tolerance = 1e-9;     ///< [rad]
  int iterations = 200;              ///< trial steps, accepted or not
  double length = 1.0;               ///< [m] weighted like 1 rad; about the reach of the machine
};

struct InverseSolution {
  VectorXd q;  ///< the best found, inside the limits, whatever the status
  InverseStatus status = InverseStatus::reached;
  double position_error = 0.0;  ///< [m] left
  double angle_error = 0.0;     ///< [rad] left; 0 where only a position is given
  int iterations = 0;
};

/// Joint positions near `start` at which the tool has the pose world_T_tool. Of several solutions, the one that the
/// iteration reaches from `start`: start from the nominal joint positions when compensating.
InverseSolution inverse(const Chain& chain, const Pose& world_T_tool, ConstVectorRef start,
                        const InverseOptions& options = {}, const Load& load = {});

/// The same for the tool point alone; its orientation is free.
InverseSolution inverse_position(const Chain& chain, const Vec3& point, ConstVectorRef start,
                                 const InverseOptions& options = {}, const Load& load = {});

}  // namespace kinfer
