// SPDX-License-Identifier: Apache-2.0
// Fits of the nominal robot's geometry to readings, and their errors.
#pragma once

#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "support/instruments.hpp"

namespace kinfer::test {

inline Estimate geometry_of(const PoseSet& data) {
  const Chain chain = nominal_robot();
  return fit_bundle(chain, calibrate::geometric_parameters(chain, data, {}), data, tracker);
}

/// [m] of the measured points.
inline double mean_error(const Chain& chain, const PoseSet& data) {
  return mean(point_errors(chain, data));
}

}  // namespace kinfer::test
