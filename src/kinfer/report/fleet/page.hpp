// SPDX-License-Identifier: Apache-2.0
// The report on a fleet: what needs attention first, each robot against all others, and what changed over time.
#pragma once

#include "kinfer/evidence/fleet/fleet.hpp"
#include "kinfer/report/parts/page.hpp"

namespace kinfer::report {

Page fleet_page(const Fleet& fleet);

}  // namespace kinfer::report
