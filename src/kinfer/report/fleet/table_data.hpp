// SPDX-License-Identifier: Apache-2.0
// The rows of a fleet for the page's script, as compact JSON: numbers with four digits, one list a row.
#pragma once

#include <string>

#include "kinfer/evidence/fleet/fleet.hpp"

namespace kinfer::report {

/// {"kind":"fleet","head":[...],"rows":[[...]]}, worst first; null where a row has no such number.
std::string fleet_table_data(const Fleet& fleet);

}  // namespace kinfer::report
