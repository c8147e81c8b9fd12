// SPDX-License-Identifier: Apache-2.0
// What a robot file says of targets, fixtures beside the robot, and places where it is mounted.
#pragma once

#include <vector>
#include "kinfer/io/robot/toml/toml_scales.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// The tables [[target]].
std::vector<Target> read_targets(TableReader& file, const Scales& scales, FirstError& first_error);

/// A table or array for each kind of fixture.
Fixtures read_fixtures(TableReader& file, const Scales& scales, FirstError& first_error);

/// The tables [[socket_distance]]; sockets that the file does not place begin at the origin.
void read_socket_distances(TableReader& file, Fixtures& fixtures, const Scales& scales, FirstError& first_error);

/// The tables [[mounting]].
std::vector<RobotMounting> read_mountings(TableReader& file, const std::vector<Joint>& joints, const Scales& scales,
                                          FirstError& first_error);

}  // namespace kinfer
