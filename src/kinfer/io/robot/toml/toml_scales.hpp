// SPDX-License-Identifier: Apache-2.0
// Units of a robot file, and frames in them.
#pragma once

#include <string_view>
#include "kinfer/io/text/toml_reader.hpp"
#include "kinfer/kinematics/frame.hpp"
#include "kinfer/measurement/measurements.hpp"

namespace kinfer {

struct Scales {
  double length = 1.0;  ///< [m]
  double angle = 1.0;   ///< [rad]

  double of(ResidualUnit unit) const {
    return unit == ResidualUnit::length ? length : unit == ResidualUnit::angle ? angle : 1.0;
  }
};

/// Of the table [units]; metres and radians without.
Scales read_scales(TableReader& file, FirstError& first_error);

/// The table `key` with xyz and rpy; none: the identity.
Frame read_frame(TableReader& file, std::string_view key, const Scales& scales, FirstError& first_error);

}  // namespace kinfer
