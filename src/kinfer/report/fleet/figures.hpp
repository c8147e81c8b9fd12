// SPDX-License-Identifier: Apache-2.0
// Drawings of a fleet, as SVG; empty where there is nothing to draw.
#pragma once

#include <string>

#include "kinfer/evidence/fleet/fleet.hpp"

namespace kinfer::report {

/// The main error of every task, sorted, on a logarithmic scale; with that before the calibration where there is one.
std::string error_drawing(const Fleet& fleet);

/// One strip a parameter: how far every robot is from the fleet's median, in robust standard deviations.
std::string parameter_drawing(const Fleet& fleet);

}  // namespace kinfer::report
