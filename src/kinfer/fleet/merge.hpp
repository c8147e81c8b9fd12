// SPDX-License-Identifier: Apache-2.0
// The fleet of many results: one value of the rows alone, so that engine, order and number of shards do not matter.
#pragma once

#include <vector>

#include "kinfer/evidence/fleet/fleet.hpp"

namespace kinfer::fleet {

/// `rows` in any order, each key once.
Fleet merge_rows(std::vector<FleetRow> rows);

}  // namespace kinfer::fleet
