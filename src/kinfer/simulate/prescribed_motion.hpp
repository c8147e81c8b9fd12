// A machine that follows its drive exactly, by our own kinematics: no physics engine, no forces, a hundred times
// faster.
#pragma once

#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// What the machine's perfect sensors say while every joint is exactly where the drive wants it.
MachineMotion prescribed_motion(const Machine& machine, const Drive& drive, double sampling_rate);

}  // namespace kinfer
