// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/clipping.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

constexpr double range_tolerance = 1e-3;  // relative: of rounding and of axes that differ a little

}  // namespace

double clipping_range(const InsSensor& sensor, const TriadColumns& triad, Fault fault) {
  double range = 0.0;
  for (std::size_t row = 0; row < sensor.rows(); ++row) {
    if (!(sensor.faults[row] & fault) || !triad.at(row).allFinite()) continue;
    const double peak = triad.at(row).cwiseAbs().maxCoeff();
    range = range > 0.0 ? std::min(range, peak) : peak;
  }
  return range;
}

ClippedSides clipped_sides(const InsSensor& sensor, const TriadColumns& triad, Fault fault, double range,
                           std::size_t row) {
  ClippedSides sides = unclipped;
  if (!(sensor.faults[row] & fault)) return sides;
  const Vec3 value = triad.at(row);
  for (std::size_t k = 0; k < 3; ++k) {
    const double on_axis = value[static_cast<Eigen::Index>(k)];
    if (std::abs(on_axis) >= (1.0 - range_tolerance) * range) sides[k] = on_axis > 0.0 ? 1 : -1;
  }
  return sides;
}

}  // namespace kinfer
