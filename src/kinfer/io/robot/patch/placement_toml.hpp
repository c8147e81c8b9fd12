// SPDX-License-Identifier: Apache-2.0
// placement.toml: where a robot stands and what it carries. It belongs to the cell, not into the robot's model.
#pragma once

#include <string>

#include "kinfer/io/robot/model/chain_ends.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"

namespace kinfer {

/// Base, tool, further mountings and targets of the chain as poses of links [m, rad], with standard deviations.
std::string format_placement_toml(const Chain& chain, const ChainEnds& ends, const StandardDeviations& sd);

}  // namespace kinfer
