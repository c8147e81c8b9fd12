// How a population searches for a robot's parameters.
#pragma once

#include "kinfer/base/angle.hpp"
#include "kinfer/search/minimise.hpp"

namespace kinfer {

struct PopulationOptions {
  SearchOptions search = PsoOptions{};
  double box_length = 1e-3;         ///< [m] half width of the box for lengths, about the nominal numbers
  double box_angle = 1.0 * degree;  ///< [rad] for angles
  double box_tolerances = 0.0;      ///< above 0: the box is this many tolerances wide to each side instead
};

}  // namespace kinfer
