// SPDX-License-Identifier: Apache-2.0
// Options of the swarm search for a robot's parameters.
#pragma once

#include <variant>

#include "kinfer/base/angle.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"
#include "kinfer/search/swarm/minimise.hpp"

namespace kinfer::calibrate {

/// Half widths of the search box about the nominal values.
struct AbsoluteBox {
  double length = 1e-3;         ///< [m]
  double angle = 1.0 * degree;  ///< [rad]
};
/// Half width in tolerances of each parameter.
struct ToleranceBox {
  double tolerances = 3.0;
};
using SearchBox = std::variant<AbsoluteBox, ToleranceBox>;

/// Updates after which a search ends where they lower the cost by less than 1 %. Larger: more certain, slower.
inline constexpr int swarm_patience = 200;

/// The updates of the program's default; a search usually ends earlier by `swarm_patience`.
inline constexpr int swarm_iterations = 20000;

struct SwarmSearchOptions {
  SearchOptions search = PsoOptions{.budget = {.max_iterations = swarm_iterations, .patience = swarm_patience}};
  SearchBox box = AbsoluteBox{};
};

SearchMethod method(const SearchOptions& search);
int particles(const SearchOptions& search);
Budget& budget(SearchOptions& search);
const Budget& budget(const SearchOptions& search);

}  // namespace kinfer::calibrate
