// SPDX-License-Identifier: Apache-2.0
// The [displacement_field] table of chain.toml: a smooth displacement of the tool over all joint positions. SI
// throughout.
#pragma once

#include <string>

#include "kinfer/io/text/toml_reader.hpp"
#include "kinfer/kinematics/displacement_field.hpp"

namespace kinfer {

std::string format_displacement_field_toml(const DisplacementField& field);

/// Empty where the file has no such table; `dof`: of the chain.
DisplacementField read_displacement_field(TableReader& file, int dof, FirstError& first_error);

}  // namespace kinfer
