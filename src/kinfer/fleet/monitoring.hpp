// SPDX-License-Identifier: Apache-2.0
// Control charts over the dated results of each robot: errors of `verify`, and parameters of `calibrate`.
#pragma once

#include <vector>

#include "kinfer/evidence/fleet/fleet.hpp"

namespace kinfer::fleet {

/// Rows with a robot and a date, in the order of dates. The limit is that at which `chart_risk` false alarms are
/// expected of all series together.
ControlChartSummary monitor(const std::vector<FleetRow>& rows);

}  // namespace kinfer::fleet
