// SPDX-License-Identifier: Apache-2.0
// The spread of each number over a fleet, and the rows that it does not explain.
#pragma once

#include "kinfer/evidence/fleet/fleet.hpp"

namespace kinfer::fleet {

/// Fills `spreads`, `deviations`, and the `deviation` of each row. Errors are compared by their logarithms, parameters
/// by their values; a value that is known less well than the fleet is spread counts by its own standard deviation.
void compare_rows(Fleet& fleet);

}  // namespace kinfer::fleet
