// SPDX-License-Identifier: Apache-2.0
// Columns that seem to be in another unit than the file claims. Nothing is corrected.
#pragma once

#include <optional>
#include <string>

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// A sentence for each instrument whose values cannot be in the unit that the file claims: gravity of 1 or 1000,
/// angular velocities beyond any real sensor, a field that exists nowhere on Earth. Empty if all is plausible.
struct UnitWarning {
  std::string sentence;  ///< "imu: gravity reads 1.00 m/s²: the file seems to be in g; write the header as imu_ax[g]"
  bool fatal = true;     ///< false: the column can be ignored
  bool is_other_unit = false;  ///< one other unit explains the values: they can be used if the file states none
  std::size_t instrument = 0;  ///< 0 specific force, 1 angular rate, 2 magnetic field
};
std::vector<UnitWarning> check_units(const InsSensor& sensor, bool field_has_unit);

/// Seconds per unit in which the times of a logger must be for its rows to be no further apart than those of a sensor
/// that can follow a machine: 1 where its file states the unit, or that of s, ms, µs or ns; none if no known unit does
/// it.
std::optional<double> clock_unit(const InsLogger& logger);

/// m/s² per unit in which the specific force must be for gravity to be right: 1, or that of g, mg or mm/s²; none if no
/// known unit explains it.
std::optional<double> acceleration_unit(const InsSensor& sensor);

/// The specific force has hardly any size while the sensor does not rotate: linear or free acceleration, from which a
/// filter has removed gravity.
bool lacks_gravity(const InsSensor& sensor);

/// µT per unit in which the field would be the Earth's: 1, or that of G, mT, T or nT; none if no known unit does it.
std::optional<double> field_unit(const InsSensor& sensor);

}  // namespace kinfer
