// SPDX-License-Identifier: Apache-2.0
// Orientations of a segment relative to its neighbour over time, against a reference in frames of its own.
#pragma once

#include <vector>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer::study::track_study {

struct RelativeOrientation {
  std::vector<double> time;    ///< [s] increasing
  std::vector<Mat3> rotation;  ///< parent_R_child; NaN: unknown
};

/// Interpolated; NaN outside and beside unknown ones.
Mat3 at(const RelativeOrientation& motion, double time);

/// [rad] rms angle between X estimate Y and the reference at its times from `begin` to `end`, X and Y constant and
/// fitted.
double rms_difference(const RelativeOrientation& estimate, const RelativeOrientation& reference, double begin,
                      double end);

}  // namespace kinfer::study::track_study
