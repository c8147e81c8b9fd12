// How fast a frame turns whose orientation is exp(φ) with a rotation vector φ that moves: smooth up to |φ| = 2π, so
// good for the joints that turn about every axis.
//
//   ω = J φ̇,  J = 1 − c1 skew(φ) + c2 skew(φ)²  (right Jacobian of SO(3)),  c1 = (1 − cos θ)/θ², c2 = (θ − sin θ)/θ³,
// in the turned frame. Derivatives by time and by φ need d = c'/θ and e = d'/θ; below a fifth of a radian by series.
#pragma once

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

struct RotationRate {
  Vec3 rate, rate_change;                 ///< ω and ω̇ in the turned frame
  Mat3 jacobian;                          ///< J: of ω by φ̇ and of ω̇ by φ̈
  Mat3 rate_by_vector;                    ///< of ω by φ
  Mat3 change_by_vector, change_by_rate;  ///< of ω̇ by φ and by φ̇
};
RotationRate rotation_rate(const Vec3& vector, const Vec3& rate, const Vec3& rate_change);

}  // namespace kinfer
