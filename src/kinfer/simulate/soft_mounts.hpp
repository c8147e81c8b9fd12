// Sensors on foam: each sways on its segment as a damped spring in six directions, tips over under its own weight and
// so moves in step with the motion.
#pragma once

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// How one sensor stands on its segment. With θ, δ its turn and shift against the segment, f and ω what a rigid sensor
/// feels, Ω = 2π frequency:  θ̈ = Ω² (tilt f − θ) − 2 damping Ω θ̇ − ω̇,  δ̈ = −Ω² stretch δ − 2 damping Ω δ̇ − f.
struct SoftMount {
  double frequency = 8.0;       ///< [Hz] of its swaying
  double damping = 0.3;         ///< of critical
  Mat3 tilt = Mat3::Zero();     ///< [rad per m/s²]
  Vec3 stretch = Vec3::Ones();  ///< stiffness of each direction over the mean
};

/// A mount that leans by about `lean` [rad] where it hangs sideways: its mass stands above the foam in some direction.
SoftMount drawn_soft_mount(double lean, double frequency, Rng rng);

/// The same motion felt by sensors on such mounts, one a sensor. They have settled before t = 0.
MachineMotion with_soft_mounts(MachineMotion motion, const std::vector<SoftMount>& mounts);

/// Every sensor on foam of its own, which sways at 8 Hz and leans by about `lean` [rad].
MachineMotion on_foam(MachineMotion motion, double lean, const Rng& rng);

}  // namespace kinfer
