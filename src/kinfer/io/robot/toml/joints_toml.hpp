// SPDX-License-Identifier: Apache-2.0
// The joints of a robot file and what closes loops between them.
#pragma once

#include <optional>
#include <string_view>
#include <vector>
#include "kinfer/io/robot/toml/toml_scales.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

enum class Convention { dh, mdh, urdf };

/// Of a table; `fallback` where it states none, an error without one.
Convention read_convention(TableReader& table, std::optional<Convention> fallback);

/// The tables [[joint]], each of which may have a convention of its own.
std::vector<Joint> read_joints(TableReader& file, Convention convention, const Scales& scales, FirstError& first_error);

/// The tables [[closure]].
std::vector<LoopClosure> read_closures(TableReader& file, const std::vector<Joint>& joints, const Scales& scales,
                                       FirstError& first_error);

/// Index of the joint named under `key`; −1 and an error where there is none.
int read_joint_reference(TableReader& row, std::string_view key, const std::vector<Joint>& joints);

}  // namespace kinfer
