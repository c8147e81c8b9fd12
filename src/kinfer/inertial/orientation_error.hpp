// How far orientations are from a reference: total, heading and inclination, as the BROAD data set defines them
// (Laidig, Caruso, Cereatti, Seel, Data 6(7), 2021): e = truth ⊗ estimate⁻¹ in world coordinates, split into a turn
// about up and a tilt.
#pragma once

#include <span>
#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// Root mean squares [rad] over the rows that count.
struct OrientationError {
  double total = 0.0, heading = 0.0, inclination = 0.0;
  std::size_t rows = 0;
};

enum class HeadingOffset {
  none,
  best_constant
};  ///< best_constant: without magnetometer, where heading has any origin

/// Rows where `counts` is 0 or the truth is not finite are left out.
OrientationError orientation_error(std::span<const Quat> estimate, std::span<const Quat> truth,
                                   std::span<const char> counts, HeadingOffset offset = HeadingOffset::none);

/// rms angle [rad] between truth and left · estimate · right with the two constant rotations that fit best, for
/// references whose world and sensor frames are both their own.
double aligned_error(std::span<const Quat> estimate, std::span<const Quat> truth);

}  // namespace kinfer
