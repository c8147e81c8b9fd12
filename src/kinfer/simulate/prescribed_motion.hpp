// A machine that follows its drive exactly, by our own kinematics: no physics engine, no forces, a hundred times
// faster.
#pragma once

#include <functional>

#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// What the machine's perfect sensors say while every joint is exactly where the drive wants it.
MachineMotion prescribed_motion(const Machine& machine, const Drive& drive, double sampling_rate);

/// The same for joints that do what `states` says, one state a reading of the machine.
using JointStates = std::function<std::vector<JointState>(double time)>;
MachineMotion prescribed_motion(const Machine& machine, double duration, double sampling_rate,
                                const JointStates& states);

}  // namespace kinfer
