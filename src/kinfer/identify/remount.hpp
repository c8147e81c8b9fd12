// A sensor that was taken off and stuck on again half way, or pushed: its mounting holds before and after, not for
// both.
//
// No orientation is needed. Across a hinge with axis j and points r in the sensors a and b, at every time
//   |ω_a × j_a| = |ω_b × j_b|        (Seel, Schauer and Raisch 2012)
//   |f_a + K_a r_a| = |f_b + K_b r_b|,  K = skew(ω̇) + skew(ω)².
// A sensor was remounted at a time where, with its own j or r allowed to differ before and after, the neighbour's being
// one and the same, a relation holds that does not hold otherwise.
#pragma once

#include <optional>

#include "kinfer/evidence/findings.hpp"
#include "kinfer/identify/ordered_motion.hpp"

namespace kinfer {

struct Remount {
  std::size_t segment = 0;         ///< whose sensor
  double begin = 0.0, end = 0.0;   ///< [s] between which it happened
  double turn = 0.0;               ///< [rad] of the joint's axis in the sensor, before against after
  double shift = 0.0;              ///< [m] of the joint's point in the sensor
  bool before_tells_more = false;  ///< about all joints together
};

/// The clearest case; nothing where no sensor was remounted beyond doubt.
std::optional<Remount> find_remount(const OrderedMotion& ordered, int threads);

/// The sentence that says it; the side that tells more is the one to go on with.
Finding finding_about(const Remount& remount, const RecordedMotion& motion);

}  // namespace kinfer
