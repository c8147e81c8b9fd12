// SPDX-License-Identifier: Apache-2.0
// Sensor remounting: a sensor that was removed and reattached, or displaced, during the recording has one mounting
// before and another one after.
//
// No orientation is needed. Across a revolute joint with axis j and points r in the sensors a and b, at every time
//   |ω_a × j_a| = |ω_b × j_b|        (Seel, Schauer and Raisch 2012)
//   |f_a + K_a r_a| = |f_b + K_b r_b|,  K = skew(ω̇) + skew(ω)².
// A sensor was remounted at time t if a relation holds when its own j or r may differ before and after t, the
// neighbour's being constant, and does not hold otherwise.
#pragma once

#include <optional>

#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer::identify {

struct Remount {
  std::size_t segment = 0;                  ///< of the remounted sensor
  double begin = 0.0, end = 0.0;            ///< [s] interval that contains the event
  double axis_rotation = 0.0;               ///< [rad] of the joint's axis in the sensor, from before to after
  double point_shift = 0.0;                 ///< [m] likewise of the joint's point
  bool before_is_more_informative = false;  ///< more informative about all joints together
};

/// The most significant remounting; none if no sensor was certainly remounted.
std::optional<Remount> find_remount(const OrderedMotion& ordered, int threads);

/// Finding; the more informative side of the event is the one to use.
Finding finding_about(const Remount& remount, const RecordedMotion& motion);

}  // namespace kinfer::identify
