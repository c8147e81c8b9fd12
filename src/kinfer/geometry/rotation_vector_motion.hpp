// SPDX-License-Identifier: Apache-2.0
// Angular velocity and acceleration of a frame with orientation exp(φ), for a time-varying rotation vector φ: smooth up
// to |φ| = 2π, so suitable for spherical joints.
//
//   ω = J φ̇,  J = 1 − c1 skew(φ) + c2 skew(φ)²  (right Jacobian of SO(3)),  c1 = (1 − cos θ)/θ², c2 = (θ − sin θ)/θ³,
// in the rotated frame. Derivatives with respect to time and φ need d = c'/θ and e = d'/θ; below 0.2 rad by series.
#pragma once

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

struct RotationVectorMotion {
  Vec3 angular_velocity, angular_acceleration;            ///< ω and ω̇ in the rotated frame
  Mat3 jacobian;                                          ///< J: of ω by φ̇ and of ω̇ by φ̈
  Mat3 velocity_by_vector;                                ///< of ω by φ
  Mat3 acceleration_by_vector, acceleration_by_velocity;  ///< of ω̇ by φ and by φ̇
};
RotationVectorMotion rotation_vector_motion(const Vec3& vector, const Vec3& angular_velocity,
                                            const Vec3& angular_acceleration);

}  // namespace kinfer
