// SPDX-License-Identifier: Apache-2.0
// Compliant sensor mounts (foam): each sensor oscillates on its segment as a damped spring in six directions and tilts
// under its own weight, in phase with the motion.
#pragma once

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// Compliance of one mount. With θ, δ the rotation and displacement of the sensor against the segment, f and ω specific
/// force and angular velocity of a rigidly mounted one, Ω = 2π frequency:
///   θ̈ = Ω² (tilt f − θ) − 2 damping Ω θ̇ − ω̇,  δ̈ = −Ω² stretch δ − 2 damping Ω δ̇ − f.
struct CompliantMount {
  double frequency = 8.0;                  ///< [Hz] natural frequency
  double damping = 0.3;                    ///< damping ratio
  Mat3 tilt = Mat3::Zero();                ///< [rad per m/s²]
  Vec3 relative_stiffness = Vec3::Ones();  ///< stiffness of each direction relative to the mean
};

/// A random mount that tilts by about `tilt` [rad] when mounted sideways; its mass is above the foam in some direction.
CompliantMount draw_compliant_mount(double tilt, double frequency, Rng rng);

/// The same motion as measured by sensors on such mounts, one per sensor, settled before t = 0.
MachineMotion with_compliant_mounts(MachineMotion motion, const std::vector<CompliantMount>& mounts);

/// Every sensor on a foam mount of its own with a natural frequency of 8 Hz that tilts by about `tilt` [rad].
MachineMotion with_foam_mounts(MachineMotion motion, double tilt, const Rng& rng);

}  // namespace kinfer
