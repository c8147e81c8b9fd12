// SPDX-License-Identifier: Apache-2.0
// Options of the swarm search for a robot's parameters.
#pragma once

#include "kinfer/base/angle.hpp"
#include "kinfer/search/swarm/minimise.hpp"

namespace kinfer::calibrate {

struct SwarmSearchOptions {
  SearchOptions search = PsoOptions{};
  double box_length = 1e-3;         ///< [m] half width of the box for lengths, about the nominal values
  double box_angle = 1.0 * degree;  ///< [rad] for angles
  double box_tolerances = 0.0;      ///< above 0: half width in tolerances, instead of the two above
};

}  // namespace kinfer::calibrate
