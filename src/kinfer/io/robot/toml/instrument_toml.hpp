// SPDX-License-Identifier: Apache-2.0
// What a robot file says of tolerances and of the instrument that measured.
#pragma once

#include <optional>
#include "kinfer/io/robot/toml/toml_scales.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/measurements.hpp"

namespace kinfer {

/// The table [tolerance]; defaults without.
Tolerances read_tolerances(TableReader& file, const Scales& scales, FirstError& first_error);

/// The table [instrument], and the place of the instrument. Empty where no accuracy is stated; those that are not are
/// zero, and estimated from the residuals.
std::optional<Instrument> read_instrument(TableReader& file, const Scales& scales, std::optional<Vec3>& at,
                                          FirstError& first_error);

}  // namespace kinfer
