// SPDX-License-Identifier: Apache-2.0
// Orientation errors against a reference: total, heading and inclination as defined by the BROAD data set (Laidig,
// Caruso, Cereatti, Seel, Data 6(7), 2021): e = truth ⊗ estimate⁻¹ in world coordinates, split into a rotation about
// the vertical and a tilt.
#pragma once

#include <span>
#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// Root mean squares [rad] over the counted rows.
struct OrientationError {
  double total = 0.0, heading = 0.0, inclination = 0.0;
  std::size_t rows = 0;
};

enum class HeadingOffset {
  none,
  best_constant
};  ///< best_constant: without magnetometer the origin of heading is arbitrary

/// Rows where `counts` is 0 or the truth is not finite are skipped.
OrientationError orientation_error(std::span<const Quat> estimate, std::span<const Quat> truth,
                                   std::span<const char> is_counted, HeadingOffset offset = HeadingOffset::none);

/// rms angle [rad] between truth and left · estimate · right with the best-fitting constant rotations, for references
/// with their own world and sensor frames.
double aligned_error(std::span<const Quat> estimate, std::span<const Quat> truth);

}  // namespace kinfer
