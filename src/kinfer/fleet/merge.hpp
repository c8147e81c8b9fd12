// SPDX-License-Identifier: Apache-2.0
// The fleet of many results: one value of the rows alone, so that engine, order and number of shards do not matter.
#pragma once

#include <vector>

#include "kinfer/evidence/fleet/fleet.hpp"

namespace kinfer::fleet {

/// Indices of the rows that a prior is made of: the latest calibration of each robot that may be used, an even sample
/// of them where there are very many. A row without a robot's name is a robot of its own.
std::vector<int> rows_of_prior(const std::vector<FleetRow>& rows);

/// `rows` in any order, each key once.
Fleet merge_rows(std::vector<FleetRow> rows);

}  // namespace kinfer::fleet
