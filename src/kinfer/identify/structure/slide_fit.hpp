// SPDX-License-Identifier: Apache-2.0
// A prismatic joint between two segments of which the parent may rotate: the axis of translation, and what it leaves.
//
// With the slide x along e, both fixed in the parent, the child's sensor p beyond the parent's at x = 0, and the
// difference b of the accelerometers' biases, the acceleration of the child relative to the parent's sensor is
//   d = K p + b + ẍ e + 2 ẋ ω × e + x K e,   K = skew(ω̇) + skew(ω)².
// The part along e is a differential equation of x, which is integrated over short windows from unknown x and ẋ at
// their beginnings. The parts across e are linear in these, p and b: a slide of tenths of a metre has Coriolis
// accelerations of nearly its own size, which tell of a joint, not against it. e follows from d by the slide found.
#pragma once

#include <optional>

#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer::identify {

struct SlideFit {
  Vec3 axis_in_parent = Vec3::UnitZ();   ///< e
  Vec3 offset_in_parent = Vec3::Zero();  ///< [m] p, as far as observable
  double residual = 0.0;                 ///< [m/s²] rms across the axis
};

/// Rotations of the child relative to the parent are ignored. Empty without motion.
std::optional<SlideFit> fit_slide(const RecordedMotion& motion, const SegmentMotion& parent,
                                  const SegmentMotion& child);

/// [m/s²] Acceleration of the child minus that of a point of the parent, in the parent.
Vec3 acceleration_beyond(const SegmentMotion& parent, const SegmentMotion& child, const Vec3& offset, std::size_t row);

}  // namespace kinfer::identify
