// SPDX-License-Identifier: Apache-2.0
// Motion of a machine that follows its drive exactly, by kinematics alone: no physics engine, no forces, a hundred
// times faster.
#pragma once

#include <functional>

#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// Signals of ideal sensors on the machine while every joint follows the drive exactly.
MachineMotion prescribed_motion(const Machine& machine, const Drive& drive, double sampling_rate);

/// The same for joint trajectories given by `states`, one state per degree of freedom of the machine.
using JointStates = std::function<std::vector<JointState>(double time)>;
MachineMotion prescribed_motion(const Machine& machine, double duration, double sampling_rate,
                                const JointStates& states);

}  // namespace kinfer
