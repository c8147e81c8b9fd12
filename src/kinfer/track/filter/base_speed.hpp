// SPDX-License-Identifier: Apache-2.0
// How fast a moving base is: the level σ of its velocity, N(0, σ²) per axis, from the filter's own estimate v with
// covariance P, σ² ← mean of (|v|² + tr P) / 3 (expectation maximisation; Dempster, Laird and Rubin 1977).
//
// A base that rocks in place has a tenth of the velocity of one that drives. The less it may have, the sooner an error
// of its tilt shows as a velocity that grows.
#pragma once

#include "kinfer/geometry/rotation.hpp"

namespace kinfer::track {

class BaseSpeed {
 public:
  BaseSpeed();

  /// Estimate and variance [m/s]² of each axis; `length` [s] that they stand for.
  void add(const Vec3& velocity, const Vec3& variance, double length);

  /// [m/s] per axis; at least what it is now, so that a base that begins to drive is believed at once.
  double sd() const;

 private:
  double mean_square_, now_ = 0.0, observed_ = 0.0;  // [m²/s²], [s]
};

}  // namespace kinfer::track
