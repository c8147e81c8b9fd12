// SPDX-License-Identifier: Apache-2.0
// Sentences about a fleet.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/fleet/fleet.hpp"

namespace kinfer::words {

/// "60 tasks: 57 use, 1 do not use, 2 refused"
std::string headline(const FleetCounts& counts);

/// "rms after fitting (held out) [mm]": a figure or parameter with its display unit.
std::string figure_name(const std::string& name);

/// "theta3 of r17 is +0.41 deg from the fleet's median (7.2 sd)"
std::string sentence(const FleetDeviation& deviation);

/// "r17: rms_m rises since 2026-03-02, noticed on 2026-03-05"
std::string sentence(const FleetAlarm& alarm);

/// How often a false alarm is to be expected, and how far processors are mixed, how many robots the prior has: what a
/// reader of the table must know.
std::vector<std::string> remarks(const Fleet& fleet);

}  // namespace kinfer::words
